#include "solver/core/label_images.h"

namespace modelsynth {

std::vector<Label> label_images(
    std::size_t label_count, std::span<const std::pair<Label, Label>> given
) {
    std::vector<Label> images(label_count, kNoLabel);
    std::vector<Label> origins(label_count, kNoLabel);
    for (const auto& [from, to] : given) {
        images[from] = to;
        origins[to] = from;
    }
    for (std::size_t i = 0; i < label_count; ++i) {
        const auto label = static_cast<Label>(i);
        if (images[label] == kNoLabel) {
            Label beginning = label;
            while (origins[beginning] != kNoLabel) {
                beginning = origins[beginning];
            }
            images[label] = beginning;
            origins[beginning] = label;
        }
    }
    return images;
}

std::optional<std::string> find_image_fault(
    std::size_t label_count, std::span<const std::pair<Label, Label>> given, std::size_t steps
) {
    LabelSet reached(label_count);
    for (const auto& [from, to] : given) {
        if (reached.contains(to)) {
            return "two of them have the same image";
        }
        reached.insert(to);
    }
    const std::vector<Label> images = label_images(label_count, given);
    for (std::size_t label = 0; steps > 0 && label < label_count; ++label) {
        auto moved = static_cast<Label>(label);
        for (std::size_t i = 0; i < steps; ++i) {
            moved = images[moved];
        }
        if (moved != label) {
            return "one of them does not come back to itself after " + std::to_string(steps) +
                   " steps";
        }
    }
    return std::nullopt;
}

Relations relations_with_images(
    const Relations& relations, std::span<const std::vector<Label>> images
) {
    std::vector<RelationId> reverse;
    for (std::size_t r = 0; r < relations.count() + 2 * images.size(); ++r) {
        reverse.push_back(static_cast<RelationId>(r ^ 1U));
    }
    Relations extended(relations.label_count(), std::move(reverse));
    for (std::size_t label = 0; label < relations.label_count(); ++label) {
        const auto near = static_cast<Label>(label);
        for (RelationId r = 0; r < relations.count(); r += 2) {
            for_each_label(relations.row(r, near), [&](Label far) {
                extended.allow(r, near, far);
            });
        }
        for (std::size_t i = 0; i < images.size(); ++i) {
            const auto to_image = static_cast<RelationId>(relations.count() + 2 * i);
            if (images[i][label] != kNoLabel) {
                extended.allow(to_image, near, images[i][label]);
            }
        }
    }
    return extended;
}

}  // namespace modelsynth
