#include "solver/examples/all.h"

#include "solver/examples/built_in.h"
#include "solver/examples/solids/built_in_solids.h"

#include <algorithm>

namespace modelsynth::examples {

std::vector<Example> all() {
    std::vector<Example> list(built_in().begin(), built_in().end());
    for (auto& solids : built_in_solids()) {
        list.emplace_back(std::move(solids));
    }
    return list;
}

std::optional<Example> find(std::string_view name) {
    if (auto solids = find_solids(name)) {
        return solids;
    }
    const auto found = std::find_if(built_in().begin(), built_in().end(), [name](const auto& grid) {
        return grid->name == name;
    });
    return found == built_in().end() ? std::nullopt : std::optional<Example>(*found);
}

}  // namespace modelsynth::examples
