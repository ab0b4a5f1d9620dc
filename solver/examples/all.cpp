#include "solver/examples/all.h"

#include "solver/examples/built_in.h"
#include "solver/examples/solids/built_in_solids.h"

#include <algorithm>

namespace modelsynth::examples {

const std::vector<Example>& all() {
    static const std::vector<Example> examples = [] {
        std::vector<Example> list(built_in().begin(), built_in().end());
        list.insert(list.end(), built_in_solids().begin(), built_in_solids().end());
        return list;
    }();
    return examples;
}

std::optional<Example> find(std::string_view name) {
    const auto found = std::find_if(all().begin(), all().end(), [name](const Example& example) {
        return name_of(example) == name;
    });
    return found == all().end() ? std::nullopt : std::optional(*found);
}

}  // namespace modelsynth::examples
