#include "solver/discrete/names.h"

namespace modelsynth::discrete {

LabelOfName labels_by_name(const Example& example) {
    LabelOfName labels;
    for (std::size_t label = 0; label < example.pieces.size(); ++label) {
        labels.emplace(example.pieces[label].name, static_cast<Label>(label));
    }
    return labels;
}

LabelSet set_of(const LabelOfName& labels, const std::vector<std::string>& names) {
    LabelSet set(labels.size());
    for (const std::string& name : names) {
        set.insert(labels.at(name));
    }
    return set;
}

std::vector<std::pair<Label, Label>> pairs_of(
    const LabelOfName& labels, std::span<const std::pair<std::string, std::string>> names
) {
    std::vector<std::pair<Label, Label>> pairs;
    for (const auto& [from, to] : names) {
        pairs.emplace_back(labels.at(from), labels.at(to));
    }
    return pairs;
}

// The outermost layer of a grid on one side.
Box layer(const GridSize& size, std::size_t side) {
    Box box = Box::whole(size);
    switch (static_cast<Direction>(side)) {
        case Direction::kEast:
            box.min.x = size.x - 1;
            break;
        case Direction::kWest:
            box.max.x = 1;
            break;
        case Direction::kUp:
            box.min.y = size.y - 1;
            break;
        case Direction::kDown:
            box.max.y = 1;
            break;
        case Direction::kSouth:
            box.min.z = size.z - 1;
            break;
        case Direction::kNorth:
            box.max.z = 1;
            break;
    }
    return box;
}

LabelSet allowed_on_side(
    const Example& example,
    const LabelOfName& labels,
    std::size_t side,
    const SideBoundary& boundary
) {
    const std::size_t count = example.pieces.size();
    if (boundary.kind == BoundaryKind::kPieces) {
        return set_of(labels, boundary.pieces);
    }
    if (boundary.kind == BoundaryKind::kExample && example.size.cell_count() > 0) {
        LabelSet set(count);
        for_each_cell(layer(example.size, side), [&](const Cell& cell) {
            set.insert(example.cells[example.size.index(cell)]);
        });
        return set;
    }
    return LabelSet::all(count);
}

std::string name_rule(const Example& example, const MemberRule& rule) {
    return "constraint " + std::to_string(rule.constraint) + " (" +
           kRuleNames.at(rule.rule.index()) + " of " + list_names(example, rule.labels) + ")";
}

std::string list_names(const Example& example, const LabelSet& labels) {
    constexpr std::size_t kMost = 8;
    std::vector<std::string> names;
    const std::size_t count = labels.count();
    for_each_label(labels.words(), [&](Label label) {
        if (names.size() < kMost) {
            names.push_back("\"" + example.pieces[label].name + "\"");
        }
    });
    if (count > kMost) {
        names.push_back(std::to_string(count - kMost) + " more");
    }
    return join_words(names);
}

std::string join_words(const std::vector<std::string>& words) {
    std::string text;
    for (std::size_t i = 0; i < words.size(); ++i) {
        text += i == 0 ? "" : i + 1 == words.size() ? " and " : ", ";
        text += words[i];
    }
    return text;
}

std::string name_cell(const Cell& cell) {
    return "[" + std::to_string(cell.x) + ", " + std::to_string(cell.y) + ", " +
           std::to_string(cell.z) + "]";
}

std::string name_sides(const GridSize& size, const Cell& cell) {
    std::vector<std::string> names;
    for (std::size_t side = 0; side < kDirectionCount; ++side) {
        if (layer(size, side).contains(cell)) {
            names.emplace_back(kSideNames[side]);
        }
    }
    if (names.empty()) {
        return "";
    }
    return "the " + join_words(names) + (names.size() == 1 ? " side" : " sides");
}

}  // namespace modelsynth::discrete
