#include "solver/continuous/display/expressions.h"

#include <algorithm>
#include <utility>

namespace modelsynth::continuous {

namespace {

// The families across whose planes an object begins or ends.
std::vector<std::size_t> families_of(const Topes& topes, const Figure& figure, char object) {
    std::vector<std::size_t> families;
    for (std::size_t family = 0; family < topes.family_count(); ++family) {
        for (std::size_t tope = 0; tope < topes.count(); ++tope) {
            const Tope beyond = topes.across(static_cast<Tope>(tope), family);
            if ((figure[tope] == object) != (figure[beyond] == object)) {
                families.push_back(family);
                break;
            }
        }
    }
    return families;
}

void sort_unique(std::vector<std::uint32_t>& points) {
    std::sort(points.begin(), points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());
}

// Variable i is whether one is in the half-space of families[i]. Beyond these it makes no
// difference where a tope lies, so topes that differ there alone are one point.
PartialFunction function_of(
    const Topes& topes, const Figure& figure, char object, const std::vector<std::size_t>& families
) {
    PartialFunction function;
    function.variables = families.size();
    for (std::size_t tope = 0; tope < topes.count(); ++tope) {
        const FamilySet above = topes.sides(static_cast<Tope>(tope));
        std::uint32_t point = 0;
        for (std::size_t i = 0; i < families.size(); ++i) {
            point |= (above >> families[i] & 1) == 0 ? std::uint32_t{1} << i : 0U;
        }
        (figure[tope] == object ? function.on : function.off).push_back(point);
    }
    sort_unique(function.on);
    sort_unique(function.off);
    return function;
}

}  // namespace

ExpressionWriter::ExpressionWriter(const Topes& topes) : topes_(topes) {
    for (std::size_t family = 0; family < topes.family_count(); ++family) {
        names_.push_back("h" + std::to_string(family + 1));
    }
}

std::optional<std::string> ExpressionWriter::write(const Figure& figure, ObjectId object) {
    const char wanted = static_cast<char>(object);
    const auto families = families_of(topes_, figure, wanted);
    PartialFunction function = function_of(topes_, figure, wanted, families);
    check(!function.on.empty(), "the object does not stand in the figure");
    auto key = std::pair(function.on, function.off);
    auto known = known_.find(key);
    if (known == known_.end()) {
        auto expression = find_short_expression(function, steps_left_);
        if (!expression) {
            return std::nullopt;
        }
        known = known_.emplace(std::move(key), std::move(*expression)).first;
    }
    if (literal_count(known->second) > kExpressionLengthMax) {
        return std::nullopt;
    }
    std::vector<std::string> names;
    for (const std::size_t family : families) {
        names.push_back(names_[family]);
    }
    return print(known->second, names);
}

std::vector<ObjectId> objects_in(const Figure& figure) {
    std::vector<ObjectId> objects;
    for (const char object : figure) {
        if (static_cast<ObjectId>(object) != kEmpty) {
            objects.push_back(static_cast<ObjectId>(object));
        }
    }
    std::sort(objects.begin(), objects.end());
    objects.erase(std::unique(objects.begin(), objects.end()), objects.end());
    return objects;
}

}  // namespace modelsynth::continuous
