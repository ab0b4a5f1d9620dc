#include "solver/continuous/planes/spacing.h"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

namespace modelsynth::continuous {

namespace {

// A minimal dependent set of normals and the absolute values of its coefficients.
struct Circuit {
    FamilySet families = 0;
    std::vector<std::pair<std::size_t, double>> members;  // family, |c|
};

std::vector<std::size_t> members_of(FamilySet families) {
    std::vector<std::size_t> members;
    for (std::size_t family = 0; family < kFamiliesMax; ++family) {
        if ((families >> family & 1) != 0) {
            members.push_back(family);
        }
    }
    return members;
}

// Three families along one line: two coefficients of the third one's normal.
Circuit circuit_of(const Topes& topes, std::array<std::size_t, 3> families) {
    const std::span<const Point> n = topes.normals();
    Eigen::Matrix<double, 3, 2> basis;
    basis.col(0) = n[families[0]];
    basis.col(1) = n[families[1]];
    const Eigen::Vector2d c =
        (basis.transpose() * basis).inverse() * (basis.transpose() * n[families[2]]);
    return {
        only(families[0]) | only(families[1]) | only(families[2]),
        {{families[0], std::abs(c[0])}, {families[1], std::abs(c[1])}, {families[2], 1}}};
}

// Four families of which no three are along one line.
Circuit circuit_of(const Topes& topes, std::array<std::size_t, 4> families) {
    const std::span<const Point> n = topes.normals();
    Eigen::Matrix3d basis;
    FamilySet set = 0;
    for (int i = 0; i < 3; ++i) {
        basis.col(i) = n[families[static_cast<std::size_t>(i)]];
    }
    for (const std::size_t family : families) {
        set |= only(family);
    }
    const Point c = basis.inverse() * n[families[3]];
    return {
        set,
        {{families[0], std::abs(c[0])},
         {families[1], std::abs(c[1])},
         {families[2], std::abs(c[2])},
         {families[3], 1}}};
}

std::vector<Circuit> circuits_of(const Figures& figures) {
    const Topes& topes = figures.topes();
    const auto is_on = [&](std::size_t a, std::size_t b, std::size_t c) {
        return (topes.lines()[topes.line_of(a, b)].families >> c & 1) != 0;
    };
    std::set<FamilySet> known;
    std::vector<Circuit> circuits;
    const auto add = [&](const Circuit& circuit) {
        if (known.insert(circuit.families).second) {
            circuits.push_back(circuit);
        }
    };
    std::set<FamilySet> needed;
    for (std::size_t label = 0; label < figures.count(); ++label) {
        needed.insert(figures.relevant(static_cast<Label>(label)));
    }
    for (const FamilySet families : needed) {
        const std::vector<std::size_t> m = members_of(families);
        for (std::size_t a = 0; a < m.size(); ++a) {
            for (std::size_t b = a + 1; b < m.size(); ++b) {
                for (std::size_t c = b + 1; c < m.size(); ++c) {
                    if (is_on(m[a], m[b], m[c])) {
                        add(circuit_of(topes, std::array{m[a], m[b], m[c]}));
                        continue;
                    }
                    for (std::size_t d = c + 1; d < m.size(); ++d) {
                        if (!is_on(m[a], m[b], m[d]) && !is_on(m[a], m[c], m[d]) &&
                            !is_on(m[b], m[c], m[d])) {
                            add(circuit_of(topes, std::array{m[a], m[b], m[c], m[d]}));
                        }
                    }
                }
            }
        }
    }
    return circuits;
}

bool is_small_ratio(double ratio) {
    for (int denominator = 1; denominator <= 4; ++denominator) {
        const double numerator = ratio * denominator;
        const double whole = std::round(numerator);
        if (whole >= 1 && whole <= 4 && std::abs(numerator - whole) < 1e-6 * whole) {
            return true;
        }
    }
    return false;
}

bool is_along_axis(const Point& normal) {
    return normal.cwiseAbs().maxCoeff() > 1 - kNormalTolerance;
}

// Of a family that nothing is asked of: planes through all points of the grid that families
// along the axes make or would make, where slopes are small ratios. What stands on a grid stays on
// it.
std::optional<double> on_grid(
    const Topes& topes, std::size_t family, double spacing, std::span<const double> spacings
) {
    std::vector<double> steps;
    for (int axis = 0; axis < 3; ++axis) {
        const double part = std::abs(topes.normals()[family][axis]);
        if (part < kNormalTolerance) {
            continue;
        }
        double along_axis = spacing;
        for (std::size_t other = 0; other < topes.family_count(); ++other) {
            if (std::abs(topes.normals()[other][axis]) > 1 - kNormalTolerance) {
                along_axis = spacings[other];
            }
        }
        steps.push_back(part * along_axis);
    }
    const double least = *std::min_element(steps.begin(), steps.end());
    const bool fits = std::all_of(steps.begin(), steps.end(), [least](double step) {
        return is_small_ratio(step / least);
    });
    return fits ? std::optional(least) : std::nullopt;
}

}  // namespace

FamilySet dependent_families(const Figures& figures) {
    FamilySet families = 0;
    for (const Circuit& circuit : circuits_of(figures)) {
        families |= circuit.families;
    }
    return families;
}

Spacings solve_spacings(
    const Figures& figures, double spacing, std::span<const double> fixed, FamilySet listed
) {
    const Topes& topes = figures.topes();
    const std::size_t m = topes.family_count();
    std::vector<Circuit> circuits = circuits_of(figures);
    std::erase_if(circuits, [listed](const Circuit& circuit) {
        return (circuit.families & listed) != 0;
    });
    std::vector<double> found(fixed.begin(), fixed.end());
    for (std::size_t family = 0; family < m; ++family) {
        const bool is_listed = (listed >> family & 1) != 0;
        if (is_listed || (found[family] == 0 && is_along_axis(topes.normals()[family]))) {
            found[family] = spacing;
        }
    }
    // The smallest spacing that some circuit with a known family asks for.
    const auto asked_for = [&](std::size_t family) {
        double least = 0;
        for (const Circuit& circuit : circuits) {
            const auto self = std::find_if(
                circuit.members.begin(),
                circuit.members.end(),
                [&](const auto& member) { return member.first == family; }
            );
            if (self == circuit.members.end()) {
                continue;
            }
            for (const auto& [other, c] : circuit.members) {
                if (other != family && found[other] > 0) {
                    const double asked = c * found[other] / self->second;
                    least = least == 0 ? asked : std::min(least, asked);
                }
            }
        }
        return least;
    };
    for (bool goes_on = true; goes_on;) {
        goes_on = false;
        std::vector<double> next = found;
        for (std::size_t family = 0; family < m; ++family) {
            if (found[family] == 0) {
                next[family] = asked_for(family);
                goes_on = goes_on || next[family] > 0;
            }
        }
        if (!goes_on) {
            const auto open = std::find(next.begin(), next.end(), 0.0);
            if (open != next.end()) {
                const auto family = static_cast<std::size_t>(open - next.begin());
                *open = on_grid(topes, family, spacing, found).value_or(spacing);
                goes_on = true;
            }
        }
        found = std::move(next);
    }

    Spacings solved = {std::move(found), {}};
    for (const std::size_t family : members_of(listed)) {
        solved.of_family[family] = 0;
    }
    for (const Circuit& circuit : circuits) {
        const auto& [first, c] = circuit.members.front();
        const double lambda = c * solved.of_family[first];
        const bool fits =
            std::all_of(circuit.members.begin(), circuit.members.end(), [&](const auto& member) {
                return is_small_ratio(member.second * solved.of_family[member.first] / lambda);
            });
        if (!fits) {
            std::string names;
            for (const auto& [family, coefficient] : circuit.members) {
                names += (names.empty() ? "" : ", ") + std::to_string(family + 1);
            }
            solved.conflicts.push_back(
                "planes h" + names + " cannot meet " +
                (circuit.members.size() == 3 ? "along one line" : "in one point") +
                " in more than a few places: their spacings do not fit"
            );
        }
    }
    return solved;
}

}  // namespace modelsynth::continuous
