#include "solver/examples/built_in.h"

namespace modelsynth::examples {

const std::vector<std::shared_ptr<const discrete::Example>>& built_in() {
    static const std::vector<std::shared_ptr<const discrete::Example>> examples = {
        std::make_shared<const discrete::Example>(make_castle()),
        std::make_shared<const discrete::Example>(make_city()),
        std::make_shared<const discrete::Example>(make_canyon())};
    return examples;
}

}  // namespace modelsynth::examples
