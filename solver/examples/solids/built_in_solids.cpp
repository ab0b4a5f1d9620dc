#include "solver/examples/solids/built_in_solids.h"

#include "solver/core/result.h"

namespace modelsynth::examples {

using continuous::ExampleReading;

const std::vector<std::shared_ptr<const ExampleReading>>& built_in_solids() {
    static const auto examples = [] {
        std::vector<std::shared_ptr<const ExampleReading>> read;
        for (const auto& make :
             {make_skyscrapers,
              make_houses,
              make_buildings,
              make_pentagons,
              make_arches,
              make_stairs,
              make_terrain,
              make_fractals}) {
            auto reading = ExampleReading::make(make());
            check(reading.has_value(), "a built-in example of solids cannot be read");
            read.push_back(std::move(*reading));
        }
        return read;
    }();
    return examples;
}

}  // namespace modelsynth::examples
