#include "solver/continuous/faults.h"

#include "solver/continuous/problem.h"
#include "solver/continuous/reading.h"
#include "solver/continuous/spacing.h"
#include "solver/continuous/symmetries.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace modelsynth::continuous {

namespace {

// So many places where three planes meet, some of them the same, are looked at.
constexpr double kMeetingsMax = 32e6;

std::string number(double value) {
    std::string text = std::to_string(value);
    text.erase(text.find_last_not_of('0') + 1);
    return text.ends_with('.') ? text.substr(0, text.size() - 1) : text;
}

// How often three planes meet in the model, counted by volumes.
double meetings(const ExampleReading& reading, const Parameters& parameters) {
    const std::span<const Point> n = reading.topes().normals();
    const std::array<double, 3>& size = *parameters.size;
    const double s = *parameters.spacing;
    double sum = 0;
    for (std::size_t a = 0; a < n.size(); ++a) {
        for (std::size_t b = a + 1; b < n.size(); ++b) {
            for (std::size_t c = b + 1; c < n.size(); ++c) {
                sum += std::abs(n[a].dot(n[b].cross(n[c])));
            }
        }
    }
    return sum * size[0] * size[1] * size[2] / (s * s * s);
}

class FaultFinder {
  public:
    FaultFinder(const ExampleReading& reading, const Parameters& parameters)
        : reading_(reading), parameters_(parameters) {}

    std::vector<Fault> find() && {
        check_size();
        is_size_good_ = faults_.empty();
        for (const auto& [name, weight] : parameters_.weights) {
            check_object("/weights", name);
        }
        for (std::size_t i = 0; i < parameters_.constraints->size(); ++i) {
            check_constraint("/constraints/" + std::to_string(i), (*parameters_.constraints)[i]);
        }
        return std::move(faults_);
    }

  private:
    void check_object(const std::string& pointer, const std::string& name) {
        if (find_object(reading_.example(), name) == kEmpty) {
            faults_.push_back({pointer, "the example has no object \"" + name + "\""});
        }
    }

    void check_constraint(const std::string& pointer, const Constraint& constraint) {
        if (const auto* dimension = std::get_if<DimensionRule>(&constraint.rule)) {
            check_object(pointer + "/object", constraint.objects.front());
            const auto& [x, y, z] = dimension->normal;
            const Point normal(x, y, z);
            const bool has_length = normal.norm() > 1e-9;  // else that is a fault of its own
            if (has_length && !reading_.topes().find_family(normal)) {
                faults_.push_back(
                    {pointer + "/normal", "no face of the example has this normal or its opposite"}
                );
            }
            return;
        }
        if (const auto* symmetry = std::get_if<SymmetryRule>(&constraint.rule)) {
            check_symmetry(pointer, *symmetry);
            return;
        }
        for (std::size_t i = 0; i < constraint.objects.size(); ++i) {
            const std::string& name = constraint.objects[i];
            if (!may_name_empty(constraint.rule) || name != kEmptyName) {
                check_object(pointer + "/objects/" + std::to_string(i), name);
            }
        }
    }

    void check_symmetry(const std::string& pointer, const SymmetryRule& rule) {
        const std::size_t before = faults_.size();
        for (const auto& [object, image] : rule.mirror) {
            for (const std::string& name : {object, image}) {
                if (name != kEmptyName) {
                    check_object(pointer + "/mirror/" + pointer_part(object), name);
                }
            }
        }
        if (faults_.size() > before || !is_size_good_) {
            return;
        }
        const std::vector<double> free(reading_.topes().family_count(), 0);
        const Spacings spacings = solve_spacings(reading_.figures(), *parameters_.spacing, free);
        const auto fault = find_symmetry_fault(
            reading_.example(),
            reading_.topes(),
            rule,
            planes_of(reading_, parameters_, spacings),
            *parameters_.size
        );
        if (fault) {
            faults_.push_back({pointer + fault->field, fault->detail});
        }
    }

    void check_size() {
        const GridSize cells = cells_of(parameters_);
        const std::int32_t longest = std::max({cells.x, cells.y, cells.z});
        const double count = meetings(reading_, parameters_);
        if (longest > kCellsAlongMax) {
            faults_.push_back(
                {"/size",
                 "is more than " + std::to_string(kCellsAlongMax) + " times the spacing of " +
                     number(*parameters_.spacing) + " metres",
                 true}
            );
        } else if (count > kMeetingsMax) {
            faults_.push_back(
                {"/size",
                 "the planes of the model would meet in some " + number(std::round(count / 1e6)) +
                     " million points, more than " + number(kMeetingsMax / 1e6) +
                     " million; a wider spacing or a smaller size helps",
                 true}
            );
        }
    }

    const ExampleReading& reading_;
    const Parameters& parameters_;
    std::vector<Fault> faults_;
    bool is_size_good_ = false;  // else there may be too many planes to look at
};

}  // namespace

std::vector<Fault> find_faults(const ExampleReading& reading, const Parameters& parameters) {
    return FaultFinder(reading, parameters).find();
}

}  // namespace modelsynth::continuous
