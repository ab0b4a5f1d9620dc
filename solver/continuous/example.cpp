#include "solver/continuous/example.h"

#include <algorithm>

namespace modelsynth::continuous {

bool operator==(const BoundingVolumeRule& one, const BoundingVolumeRule& other) {
    return *one.shape == *other.shape;
}

ObjectId find_object(const Example& example, const std::string& name) {
    const auto found =
        std::find_if(example.objects.begin(), example.objects.end(), [&](const ObjectType& object) {
            return object.name == name;
        });
    const auto number = found - example.objects.begin();
    return found == example.objects.end() ? kEmpty : static_cast<ObjectId>(number + 1);
}

}  // namespace modelsynth::continuous
