#include "solver/continuous/shapes/bounding_volumes.h"

#include "solver/continuous/shapes/cut_boxes.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>

namespace modelsynth::continuous {

namespace {

// The shapes in the whole boxes of the example.
Example whole_with(const Example& example, std::span<const BoundingVolume> volumes) {
    Example whole = with_whole_boxes(example);
    for (const BoundingVolume& volume : volumes) {
        whole.objects[volume.object - 1U].shape = volume.rule.shape;
    }
    return whole;
}

// What is wrong with one shape, told at its constraint.
std::vector<Fault> faults_at(
    const std::string& pointer, const Example& example, const BoundingVolume& volume
) {
    std::vector<Fault> faults = find_shape_faults(whole_with(example, {&volume, 1}));
    const std::string own = "/objects/" + std::to_string(volume.object - 1) + "/shape";
    for (Fault& fault : faults) {
        if (fault.pointer.starts_with(own)) {
            fault.pointer = pointer + fault.pointer.substr(own.size());
        } else {
            fault.detail = fault.pointer + " of the example: " + fault.detail;
            fault.pointer = pointer + "/object";
        }
    }
    return faults;
}

}  // namespace

Result<std::vector<BoundingVolume>> bounding_volumes_of(
    const Example& example, const Parameters& parameters
) {
    std::vector<BoundingVolume> volumes;
    std::vector<Fault> faults;
    for (std::size_t i = 0; i < parameters.constraints->size(); ++i) {
        const Constraint& constraint = (*parameters.constraints)[i];
        const auto* rule = std::get_if<BoundingVolumeRule>(&constraint.rule);
        const ObjectId object = rule == nullptr || constraint.objects.empty()
                                    ? kEmpty
                                    : find_object(example, constraint.objects.front());
        if (object == kEmpty) {
            continue;
        }
        const std::string pointer = "/constraints/" + std::to_string(i);
        const bool is_second =
            std::any_of(volumes.begin(), volumes.end(), [object](const BoundingVolume& other) {
                return other.object == object;
            });
        if (is_second) {
            faults.push_back({pointer + "/object", "has a bounding volume by another constraint"});
        } else if (example.objects[object - 1U].rest_of != kEmpty) {
            faults.push_back({pointer + "/object", "is a part of the boxes of another object"});
        } else {
            volumes.push_back({object, *rule});
            const std::vector<Fault> own = faults_at(pointer, example, volumes.back());
            faults.insert(faults.end(), own.begin(), own.end());
        }
    }
    if (faults.empty() && !volumes.empty()) {
        // Each may have room for what is cut off its boxes, and all of them not.
        faults = find_shape_faults(whole_with(example, volumes));
        for (Fault& fault : faults) {
            fault.pointer = "/constraints";
        }
    }
    if (!faults.empty()) {
        return tl::unexpected(Error{
            ErrorCode::kInvalidArgument,
            "a bounding volume does not suit the example",
            std::move(faults)});
    }
    std::sort(volumes.begin(), volumes.end(), [](const auto& a, const auto& b) {
        return a.object < b.object;
    });
    return volumes;
}

Example with_bounding_volumes(const Example& example, std::span<const BoundingVolume> volumes) {
    Example changed = whole_with(example, volumes);
    cut_boxes(changed);
    return changed;
}

}  // namespace modelsynth::continuous
