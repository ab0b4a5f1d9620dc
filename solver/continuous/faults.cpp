#include "solver/continuous/faults.h"

#include "solver/continuous/planes/model_planes.h"
#include "solver/continuous/reading/reading.h"
#include "solver/continuous/symmetry/symmetry_fault.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace modelsynth::continuous {

namespace {

// So many places where three planes meet, some of them the same, are looked at.
constexpr double kMeetingsMax = 32e6;

// So many lines are walked along, some seconds' worth.
constexpr double kLinesMax = 256e6;

Point point_of(const std::array<double, 3>& numbers) {
    return {numbers[0], numbers[1], numbers[2]};
}

std::string number(double value) {
    std::string text = std::to_string(value);
    text.erase(text.find_last_not_of('0') + 1);
    return text.ends_with('.') ? text.substr(0, text.size() - 1) : text;
}

// How many planes of each family there are, counted by lengths; each is at least one.
std::vector<double> count_planes(const ExampleReading& reading, const Parameters& parameters) {
    const std::span<const Point> normals = reading.topes().normals();
    const Bounds box = arranged_box(reading, parameters);
    const Spacings spacings = spacings_of(reading, parameters);
    std::vector<double> counts;
    for (std::size_t family = 0; family < normals.size(); ++family) {
        const Reach reach = reach_along(normals[family], box);
        const double spacing = spacings.of_family[family];
        counts.push_back(spacing > 0 ? std::max(1.0, (reach.high - reach.low) / spacing) : 1);
    }
    for (const FamilyOffsets& listed : parameters.offsets) {
        const auto family = *reading.find_family(point_of(listed.normal));
        counts[family] = std::max(counts[family], static_cast<double>(listed.offsets.size()));
    }
    return counts;
}

// In how many lines two planes meet, were the model a cube.
double lines_of(std::span<const double> counts) {
    double sum = 0;
    for (std::size_t a = 0; a < counts.size(); ++a) {
        for (std::size_t b = a + 1; b < counts.size(); ++b) {
            sum += counts[a] * counts[b];
        }
    }
    return sum;
}

// How often three planes meet in the model, counted by volumes; `steps` tells how far those of each
// family lie apart on average.
double meetings(
    const ExampleReading& reading, const Parameters& parameters, std::span<const double> steps
) {
    const std::span<const Point> n = reading.topes().normals();
    const Bounds box = arranged_box(reading, parameters);
    double sum = 0;
    for (std::size_t a = 0; a < n.size(); ++a) {
        for (std::size_t b = a + 1; b < n.size(); ++b) {
            for (std::size_t c = b + 1; c < n.size(); ++c) {
                sum += std::abs(n[a].dot(n[b].cross(n[c]))) / (steps[a] * steps[b] * steps[c]);
            }
        }
    }
    return sum * (box.max - box.min).prod();
}

class FaultFinder {
  public:
    FaultFinder(const ExampleReading& reading, const Parameters& parameters)
        : reading_(reading), parameters_(parameters) {}

    std::vector<Fault> find() && {
        if (check_families()) {
            check_size();
        }
        check_disorder();
        is_size_good_ = faults_.empty();
        for (const auto& [name, weight] : parameters_.weights) {
            check_object("/weights/" + pointer_part(name), name);
        }
        for (std::size_t i = 0; i < parameters_.constraints->size(); ++i) {
            check_constraint("/constraints/" + std::to_string(i), (*parameters_.constraints)[i]);
        }
        return std::move(faults_);
    }

  private:
    // What is moved at random has no image.
    void check_disorder() {
        const bool is_symmetric = std::any_of(
            parameters_.constraints->begin(),
            parameters_.constraints->end(),
            [](const Constraint& constraint) {
                return std::holds_alternative<SymmetryRule>(constraint.rule);
            }
        );
        const std::string detail = "must be 0 where there is a symmetry";
        if (is_symmetric && parameters_.jitter > 0) {
            faults_.push_back({"/jitter", detail});
        }
        if (is_symmetric && parameters_.perturbation > 0) {
            faults_.push_back({"/perturbation", detail});
        }
    }

    void check_object(const std::string& pointer, const std::string& name) {
        if (find_object(reading_.example(), name) == kEmpty) {
            faults_.push_back({pointer, "the example has no object \"" + name + "\""});
        }
    }

    void check_constraint(const std::string& pointer, const Constraint& constraint) {
        if (const auto* dimension = std::get_if<DimensionRule>(&constraint.rule)) {
            if (!constraint.objects.empty()) {  // else that is a fault of its own
                check_object(pointer + "/object", constraint.objects.front());
            }
            const Point normal = point_of(dimension->normal);
            const bool has_length = normal.norm() > 1e-9;  // else that is a fault of its own
            if (has_length && !reading_.find_family(normal)) {
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
        if (std::holds_alternative<BoundingVolumeRule>(constraint.rule)) {
            if (!constraint.objects.empty()) {
                check_object(pointer + "/object", constraint.objects.front());
            }
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
        for (const auto& [object, image] : rule.mirror.value_or(NamePairs())) {
            for (const std::string& name : {object, image}) {
                if (name != kEmptyName) {
                    check_object(pointer + "/mirror/" + pointer_part(object), name);
                }
            }
        }
        if (faults_.size() > before || !is_size_good_) {
            return;
        }
        const auto fault = find_symmetry_fault(
            reading_, rule, make_planes(reading_, parameters_).offsets, *parameters_.size
        );
        if (fault) {
            faults_.push_back({pointer + fault->field, fault->detail});
        }
    }

    // False where the planes of the model cannot be said.
    bool check_families() {
        bool is_sound = true;
        std::vector<std::string> place_of(reading_.topes().family_count());
        for (std::size_t i = 0; i < parameters_.spacings.size(); ++i) {
            const std::string pointer = "/spacing/" + std::to_string(i);
            is_sound &= check_family(pointer, parameters_.spacings[i].normal, place_of);
        }
        for (std::size_t i = 0; i < parameters_.offsets.size(); ++i) {
            const std::string pointer = "/offsets/" + std::to_string(i);
            is_sound &= check_family(pointer, parameters_.offsets[i].normal, place_of);
        }
        return is_sound;
    }

    // False where the planes are of no family, or of one that has some.
    bool check_family(
        const std::string& pointer,
        const std::array<double, 3>& normal,
        std::vector<std::string>& place_of
    ) {
        if (point_of(normal).norm() <= 1e-9) {
            return false;  // a fault of its own
        }
        const auto family = reading_.find_family(point_of(normal));
        if (!family) {
            faults_.push_back(
                {pointer + "/normal", "no face of the example has this normal or its opposite"}
            );
            return false;
        }
        std::string& place = place_of[*family];
        if (!place.empty()) {
            faults_.push_back(
                {pointer + "/normal", "these planes are those of " + place + " already"}
            );
            return false;
        }
        place = pointer;
        return true;
    }

    void check_size() {
        const GridSize cells = cells_of(parameters_);
        const std::int32_t longest = std::max({cells.x, cells.y, cells.z});
        if (longest > kCellsAlongMax) {
            faults_.push_back(
                {"/size",
                 "is more than " + std::to_string(kCellsAlongMax) + " times the spacing of " +
                     number(*parameters_.spacing) + " metres",
                 true}
            );
        } else if (parameters_.spacings.empty() && parameters_.offsets.empty() && reading_.nudged() == nullptr) {
            // What follows from one spacing is close to it: not worth the time to work it out.
            const std::size_t families = reading_.topes().family_count();
            check_meetings(std::vector<double>(families, *parameters_.spacing));
        } else {
            check_planes();
        }
    }

    void check_planes() {
        const std::vector<double> counts = count_planes(reading_, parameters_);
        const double most = *std::max_element(counts.begin(), counts.end());
        if (most > static_cast<double>(kPlanesMax) || lines_of(counts) > kLinesMax) {
            faults_.push_back(
                {parameters_.spacings.empty() ? "/size" : "/spacing",
                 "there would be too many planes, up to " + number(std::round(most)) +
                     " of one direction; a wider spacing or a smaller size helps",
                 true}
            );
            return;
        }
        const Bounds box = arranged_box(reading_, parameters_);
        std::vector<double> steps;
        for (std::size_t family = 0; family < counts.size(); ++family) {
            const Reach reach = reach_along(reading_.topes().normals()[family], box);
            steps.push_back((reach.high - reach.low) / counts[family]);
        }
        check_meetings(steps);
    }

    void check_meetings(std::span<const double> steps) {
        const double count = meetings(reading_, parameters_, steps);
        if (count > kMeetingsMax) {
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
