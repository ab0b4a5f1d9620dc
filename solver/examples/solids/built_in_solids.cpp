#include "solver/examples/solids/built_in_solids.h"

#include "solver/core/result.h"

#include <algorithm>
#include <array>
#include <mutex>

namespace modelsynth::examples {

using continuous::ExampleReading;

namespace {

struct Entry {
    std::string_view name;
    continuous::Example (*make)();
};

constexpr std::array kEntries = {
    Entry{"houses", make_houses},
    Entry{"skyscrapers", make_skyscrapers},
    Entry{"letters", make_letters},
    Entry{"domes", make_domes},
    Entry{"buildings", make_buildings},
    Entry{"pentagons", make_pentagons},
    Entry{"arches", make_arches},
    Entry{"stairs", make_stairs},
    Entry{"terrain", make_terrain},
    Entry{"fractals", make_fractals},
    Entry{"roads", make_roads},
    Entry{"plumbing", make_plumbing},
    Entry{"oil_platform", make_oil_platform},
    Entry{"roller_coaster", make_roller_coaster},
    Entry{"spaceships", make_spaceships},
};

struct Known {
    std::once_flag once;
    std::shared_ptr<const ExampleReading> reading;
};

std::shared_ptr<const ExampleReading> read(std::size_t number) {
    static std::array<Known, kEntries.size()> known;
    std::call_once(known[number].once, [number] {
        auto reading = ExampleReading::make(kEntries[number].make());
        check(reading.has_value(), "a built-in example of solids cannot be read");
        known[number].reading = std::move(*reading);
    });
    return known[number].reading;
}

}  // namespace

std::shared_ptr<const ExampleReading> find_solids(std::string_view name) {
    const auto found = std::find_if(kEntries.begin(), kEntries.end(), [name](const Entry& entry) {
        return entry.name == name;
    });
    return found == kEntries.end() ? nullptr
                                   : read(static_cast<std::size_t>(found - kEntries.begin()));
}

std::vector<std::shared_ptr<const ExampleReading>> built_in_solids() {
    std::vector<std::shared_ptr<const ExampleReading>> all;
    for (std::size_t number = 0; number < kEntries.size(); ++number) {
        all.push_back(read(number));
    }
    return all;
}

}  // namespace modelsynth::examples
