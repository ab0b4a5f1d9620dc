#include "solver/continuous/import/import_settings.h"

#include "solver/continuous/check/solid_check.h"

#include <cmath>
#include <cstddef>
#include <utility>
#include <variant>

namespace modelsynth::continuous {

namespace {

// As many as there is any use for: every object across every family.
constexpr std::size_t kDimensionsMax = 1024;

std::optional<double> positive_number(const Extra& extra) {
    const auto* number = std::get_if<double>(&extra.value);
    return number != nullptr && *number > 0 && *number <= kCoordinateMax ? std::optional(*number)
                                                                         : std::nullopt;
}

std::optional<std::array<double, 3>> three_numbers(const Extra& extra) {
    const auto* list = std::get_if<Extra::List>(&extra.value);
    if (list == nullptr || list->size() != 3) {
        return std::nullopt;
    }
    std::array<double, 3> numbers = {};
    for (std::size_t i = 0; i < 3; ++i) {
        const auto* number = std::get_if<double>(&(*list)[i].value);
        if (number == nullptr || !(std::abs(*number) <= kCoordinateMax)) {
            return std::nullopt;
        }
        numbers[i] = *number;
    }
    return numbers;
}

std::optional<Point> point_at(const Extra& extra, const char* name) {
    const Extra* member = extra.find(name);
    const auto numbers = member == nullptr ? std::nullopt : three_numbers(*member);
    return numbers ? std::optional(Point((*numbers)[0], (*numbers)[1], (*numbers)[2]))
                   : std::nullopt;
}

class SettingsReader {
  public:
    SettingsReader(const Extra& extras, const std::string& pointer, std::vector<Fault>& faults)
        : extras_(extras), pointer_(pointer), faults_(faults) {}

    void read(ImportSettings& settings) {
        read_numbers(settings);
        read_bounds(settings);
        read_dimensions(settings);
    }

  private:
    void refuse(const std::string& member, const char* detail) {
        faults_.push_back({pointer_ + "/" + member, detail});
    }

    void read_numbers(ImportSettings& settings) {
        if (const Extra* spacing = extras_.find("spacing")) {
            settings.spacing = positive_number(*spacing);
            if (!settings.spacing) {
                refuse("spacing", "the spacing is not a number of metres above 0");
            }
        }
        if (const Extra* size = extras_.find("size")) {
            settings.size = three_numbers(*size);
            if (!settings.size ||
                !((*settings.size)[0] > 0 && (*settings.size)[1] > 0 && (*settings.size)[2] > 0)) {
                refuse("size", "the size is not three numbers of metres above 0");
            }
        }
        if (const Extra* density = extras_.find("density")) {
            settings.density = positive_number(*density);
            if (!settings.density || *settings.density > 1) {
                refuse("density", "the density is not a number above 0 and at most 1");
            }
        }
    }

    void read_bounds(ImportSettings& settings) {
        const Extra* bounds = extras_.find("bounds");
        if (bounds == nullptr) {
            return;
        }
        const auto min = point_at(*bounds, "min");
        const auto max = point_at(*bounds, "max");
        if (min && max && (min->array() < max->array()).all()) {
            settings.bounds = Bounds{*min, *max};
        } else {
            refuse("bounds", "bounds need a \"min\" of three numbers below those of a \"max\"");
        }
    }

    void read_dimensions(ImportSettings& settings) {
        const Extra* dimensions = extras_.find("dimensions");
        if (dimensions == nullptr) {
            return;
        }
        const auto* list = std::get_if<Extra::List>(&dimensions->value);
        if (list == nullptr || list->size() > kDimensionsMax) {
            refuse("dimensions", "the dimensions are not a list of at most 1024");
            return;
        }
        settings.dimensions.clear();
        for (std::size_t i = 0; i < list->size(); ++i) {
            const std::string member = "dimensions/" + std::to_string(i);
            const Extra* object = (*list)[i].find("object");
            const auto* name =
                object == nullptr ? nullptr : std::get_if<std::string>(&object->value);
            const auto normal = point_at((*list)[i], "normal");
            if (name == nullptr || !normal || normal->norm() < 1e-9) {
                refuse(member, "a dimension needs an \"object\" and a \"normal\" of three numbers");
                continue;
            }
            settings.dimensions.push_back({*name, *normal, pointer_ + "/" + member});
        }
    }

    const Extra& extras_;
    const std::string& pointer_;
    std::vector<Fault>& faults_;
};

}  // namespace

void read_import_settings(
    const Extra& extras,
    const std::string& pointer,
    ImportSettings& settings,
    std::vector<Fault>& faults
) {
    SettingsReader(extras, pointer, faults).read(settings);
}

}  // namespace modelsynth::continuous
