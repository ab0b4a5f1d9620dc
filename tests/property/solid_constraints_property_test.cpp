// Constraints of solids: random ones on random examples, and what one sees of the models.
// MODELSYNTH_SOLID_PERCENT asks for a longer run.

#include "solver/continuous/constraints/connections.h"
#include "solver/continuous/faults.h"
#include "solver/continuous/planes/skeleton.h"
#include "solver/continuous/surface/surface.h"
#include "solver/continuous/symmetry/figure_images.h"
#include "solver/continuous/synthesis.h"
#include "solver/examples/solids/built_in_solids.h"
#include "tests/support/case_count.h"
#include "tests/support/examples.h"
#include "tests/support/random_solids.h"
#include "tests/support/solid_places.h"
#include "tests/support/surface_checker.h"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <numeric>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace modelsynth::continuous {
namespace {

using testing::RecordingObserver;
using testing::solid_case_count;
using testing::SolidPlaces;
using testing::SolidsKind;
using testing::SurfaceChecker;

using Reading = std::shared_ptr<const ExampleReading>;

// Of the standard library the engine alone is the same everywhere.
class Chance {
  public:
    explicit Chance(std::uint64_t seed) : random_(seed) {}

    int below(int bound) { return static_cast<int>(random_() % static_cast<std::uint64_t>(bound)); }

    double share() { return static_cast<double>(random_() % 1'000'003) / 1'000'003; }

  private:
    std::mt19937_64 random_;
};

// A random request for a model of whole spacings, whose regions follow the planes of the axes.
class RequestMaker {
  public:
    RequestMaker(const ExampleReading& reading, std::uint64_t seed, int extent_max)
        : reading_(reading), chance_(seed) {
        for (int& extent : extent_) {
            extent = 3 + chance_.below(extent_max - 2);
        }
    }

    Parameters make() {
        if (chance_.below(3) == 0) {
            extent_[2] = extent_[0];  // for quarter turns
        }
        Parameters parameters;
        parameters.size = {1.0 * extent_[0], 1.0 * extent_[1], 1.0 * extent_[2]};
        parameters.density = 0.3 + 0.7 * chance_.share();
        Blocks blocks;
        blocks.layout.size = {2 + chance_.below(4), 2 + chance_.below(4), 2 + chance_.below(4)};
        blocks.layout.passes = 1U + static_cast<std::uint32_t>(chance_.below(2));
        parameters.blocks = blocks;
        if (chance_.below(8) == 0) {
            parameters.blocks->reset();
        }
        parameters.constraints.emplace();
        for (int i = 1 + chance_.below(3); i > 0; --i) {
            parameters.constraints->push_back(constraint());
        }
        return fill_defaults(parameters, reading_.example());
    }

    // A box of whole spacings.
    MetreBox box() {
        MetreBox box;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const int low = chance_.below(extent_[axis]);
            box.min[axis] = low;
            box.max[axis] = low + 1 + chance_.below(std::min(3, extent_[axis] - low));
        }
        return box;
    }

  private:
    Constraint constraint() {
        switch (chance_.below(10)) {
            case 8:
            case 9:
                return {symmetry()};
            case 0: {
                const std::span<const Point> normals = reading_.topes().normals();
                const Point& n =
                    normals[static_cast<std::size_t>(chance_.below(static_cast<int>(normals.size()))
                    )];
                return {
                    DimensionRule{{n.x(), n.y(), n.z()}, 1 + chance_.below(3)}, {object(false)}};
            }
            case 1:
            case 2:
            case 3:
                return {
                    ConnectedRule{1U + static_cast<std::uint32_t>(chance_.below(3))},
                    objects(false)};
            case 4:
                return {FixedRule{}, objects(true), region()};
            case 5:
                return {ForbiddenRule{}, objects(true), region()};
            case 6:
                return {ProbabilityRule{0}, objects(false), region()};
            default:
                return {ProbabilityRule{4 * chance_.share()}, objects(false), region()};
        }
    }

    SymmetryRule symmetry() {
        SymmetryRule rule;
        rule.kind = static_cast<SymmetryRule::Kind>(chance_.below(5));
        if (rule.kind == SymmetryRule::Kind::kTranslate) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                rule.translation[axis] = chance_.below(2 * extent_[axis]) - extent_[axis];
            }
        }
        if (chance_.below(3) == 0) {
            rule.mirror = {{object(false), object(false)}};
        }
        return rule;
    }

    std::string object(bool may_be_empty) {
        const auto& all = reading_.example().objects;
        const int number = chance_.below(static_cast<int>(all.size()) + (may_be_empty ? 1 : 0));
        return number == static_cast<int>(all.size()) ? kEmptyName
                                                      : all[static_cast<std::size_t>(number)].name;
    }

    std::vector<std::string> objects(bool may_be_empty) {
        std::vector<std::string> names;
        for (int i = 1 + chance_.below(3); i > 0; --i) {
            names.push_back(object(may_be_empty));
        }
        return names;
    }

    Region region() {
        Region region;
        const int kind = chance_.below(8);
        if (kind < 4) {
            region.box = box();
        }
        if (kind == 4 || kind == 3) {
            Mask& mask = region.mask.emplace();
            mask.width = extent_[0];
            mask.depth = extent_[2];
            for (int i = 0; i < mask.width * mask.depth; ++i) {
                mask.values.push_back(
                    static_cast<std::uint8_t>(chance_.below(5) == 0 ? 255 : 64 * chance_.below(3))
                );
            }
        }
        if (kind == 5 || kind == 6) {
            Voxels& voxels = region.voxels.emplace();
            voxels.size = {extent_[0], extent_[1], extent_[2]};
            for (std::size_t i = 0; i < voxels.size.cell_count(); ++i) {
                voxels.values.push_back(chance_.below(8) == 0 ? 1 : chance_.below(2) * 0.5);
            }
        }
        return region;
    }

    const ExampleReading& reading_;
    Chance chance_;
    std::array<int, 3> extent_ = {};
};

// Whether a region, which holds everywhere when it says nothing, holds all of a cell of one
// spacing: said anew, without Coverage.
bool holds_cell(const Region& region, const Cell& cell) {
    const std::array<double, 3> middle = {cell.x + 0.5, cell.y + 0.5, cell.z + 0.5};
    if (!region.box && !region.mask && !region.voxels) {
        return true;
    }
    bool is_in_box = region.box.has_value();
    for (std::size_t axis = 0; axis < 3 && is_in_box; ++axis) {
        is_in_box = region.box->min[axis] < middle[axis] && middle[axis] < region.box->max[axis];
    }
    const bool is_in_mask =
        region.mask &&
        region.mask->values[static_cast<std::size_t>(cell.x + cell.z * region.mask->width)] == 255;
    const bool is_in_voxels =
        region.voxels && region.voxels->values[region.voxels->size.index(cell)] == 1;
    return is_in_box || is_in_mask || is_in_voxels;
}

bool names(const Constraint& constraint, const Example& example, ObjectId object) {
    const std::string& name = object == kEmpty ? kEmptyName : example.objects[object - 1U].name;
    return std::find(constraint.objects.begin(), constraint.objects.end(), name) !=
           constraint.objects.end();
}

bool may_stand(const Constraint& constraint, const Example& example, ObjectId object) {
    if (std::holds_alternative<FixedRule>(constraint.rule)) {
        return names(constraint, example, object);
    }
    const auto* probability = std::get_if<ProbabilityRule>(&constraint.rule);
    const bool is_ban = std::holds_alternative<ForbiddenRule>(constraint.rule) ||
                        (probability != nullptr && probability->weight == 0);
    return !is_ban || !names(constraint, example, object);
}

std::vector<ObjectId> objects_of(const Constraint& constraint, const Example& example) {
    std::vector<ObjectId> objects;
    for (std::size_t i = 0; i < example.objects.size(); ++i) {
        if (names(constraint, example, static_cast<ObjectId>(i + 1))) {
            objects.push_back(static_cast<ObjectId>(i + 1));
        }
    }
    return objects;
}

// What a symmetry turns a model by; nothing for those that only move it.
std::optional<Eigen::Matrix3d> turn_of(const SymmetryRule& rule) {
    constexpr std::array<std::array<double, 4>, 4> kTurns = {
        {{-1, 0, 0, 1}, {1, 0, 0, -1}, {-1, 0, 0, -1}, {0, 1, -1, 0}}};
    const auto kind = static_cast<std::size_t>(rule.kind);
    if (kind >= kTurns.size()) {
        return std::nullopt;
    }
    const auto& [xx, xz, zx, zz] = kTurns.at(kind);
    Eigen::Matrix3d turn;
    turn << xx, 0, xz, 0, 1, 0, zx, 0, zz;
    return turn;
}

std::vector<ObjectId> images_of_objects(const ExampleReading& reading, const SymmetryRule& rule) {
    const Example& example = reading.example();
    std::vector<ObjectId> images(example.objects.size() + 1);
    std::iota(images.begin(), images.end(), ObjectId{0});
    for (const auto& [object, image] : rule.mirror ? *rule.mirror : likely_mirror(reading, rule)) {
        images[find_object(example, object)] = find_object(example, image);
        ObjectId& back = images[find_object(example, image)];
        back = back == find_object(example, image) ? find_object(example, object) : back;
    }
    // Shapes become what they are once they are turned, and so does what was cut off them.
    const auto turn = turn_of(rule);
    for (std::size_t a = 0; turn && a < example.objects.size(); ++a) {
        const ObjectType& from = example.objects[a];
        for (std::size_t b = 0; b < example.objects.size(); ++b) {
            const ObjectType& to = example.objects[b];
            const auto base = [](const ObjectType& type, std::size_t object) {
                return type.variant_of == kEmpty ? object + 1 : std::size_t{type.variant_of};
            };
            if ((from.shape != nullptr || from.rest_of != kEmpty) && base(from, a) == base(to, b) &&
                *turn * from.turn == to.turn) {
                images[a + 1] = static_cast<ObjectId>(b + 1);
            }
        }
    }
    return images;
}

// The example as it is read where shapes have images: with what the symmetries make of it beside.
Example with_images(const ExampleReading& reading) {
    Example example = reading.example();
    std::vector<std::vector<Polyhedron>> copies = {example.polyhedra};
    constexpr std::size_t kCopiesMax = 8;
    for (std::size_t i = 0; i < copies.size() && copies.size() < kCopiesMax; ++i) {
        for (const SymmetryRule& rule : reading.options().symmetries) {
            const std::vector<ObjectId> images = images_of_objects(reading, rule);
            const Eigen::Matrix3d turn = *turn_of(rule);
            std::vector<Polyhedron>& copy = copies.emplace_back(copies[i]);
            for (Polyhedron& solid : copy) {
                solid.object = images[solid.object];
                for (Point& corner : solid.corners) {
                    corner = turn * corner;
                }
                for (Face& face : solid.faces) {
                    if (turn.determinant() < 0) {
                        std::reverse(face.begin(), face.end());
                    }
                }
            }
        }
    }
    for (std::size_t i = 1; i < copies.size(); ++i) {
        for (Polyhedron& solid : copies[i]) {
            for (Point& corner : solid.corners) {
                corner.x() += 100 * static_cast<double>(i);
            }
            example.polyhedra.push_back(std::move(solid));
        }
    }
    return example;
}

// Looks at a model by its polygons.
class ModelLooker {
  public:
    ModelLooker(const Problem& problem, const Parameters& parameters, const Surface& surface)
        : problem_(problem),
          example_(problem.reading->example()),
          parameters_(parameters),
          places_(
              surface,
              example_.objects.size(),
              {problem.arrangement.frame().box.min, problem.arrangement.frame().box.max}
          ) {}

    [[nodiscard]] const SolidPlaces& places() const { return places_; }

    void expect_kept(const Constraint& constraint, Chance& chance) const {
        if (const auto* connected = std::get_if<ConnectedRule>(&constraint.rule)) {
            EXPECT_LE(places_.pieces(objects_of(constraint, example_)), connected->components);
        } else if (const auto* dimension = std::get_if<DimensionRule>(&constraint.rule)) {
            expect_dimension(constraint, *dimension, chance);
        } else if (const auto* symmetry = std::get_if<SymmetryRule>(&constraint.rule)) {
            expect_symmetry(*symmetry, chance);
        } else {
            expect_region(constraint, chance);
        }
    }

  private:
    void expect_region(const Constraint& constraint, Chance& chance) const {
        for_each_cell(Box::whole(cells_of(parameters_)), [&](const Cell& cell) {
            if (!holds_cell(constraint.region, cell)) {
                return;
            }
            for (int i = 0; i < 2; ++i) {
                const Point place = Point(
                    cell.x + chance.share(), cell.y + chance.share(), cell.z + chance.share()
                );
                const ObjectId object = places_.at(place);
                EXPECT_TRUE(may_stand(constraint, example_, object))
                    << "object " << int{object} << " at " << place.transpose() << " is not to be";
            }
        });
    }

    // What stands at a place's image is the image of what stands there.
    void expect_symmetry(const SymmetryRule& rule, Chance& chance) const {
        const std::vector<ObjectId> images = images_of_objects(*problem_.reading, rule);
        const Eigen::AlignedBox3d box = places_.set().frame().clip;
        const Point middle(box.center().x(), 0, box.center().z());
        for (int i = 0; i < 200; ++i) {
            const Point share(chance.share(), chance.share(), chance.share());
            const Point place = box.min() + share.cwiseProduct(box.sizes());
            const Point from_middle = place - middle;
            const std::array<Point, 5> moved = {
                middle + Point(-from_middle.x(), place.y(), from_middle.z()),
                middle + Point(from_middle.x(), place.y(), -from_middle.z()),
                middle + Point(-from_middle.x(), place.y(), -from_middle.z()),
                middle + Point(from_middle.z(), place.y(), -from_middle.x()),
                place + Point(rule.translation[0], rule.translation[1], rule.translation[2])};
            const Point& there = moved.at(static_cast<std::size_t>(rule.kind));
            // Below y = 0 the ground stands for good.
            if (box.contains(there) && place.y() > 0 && there.y() > 0) {
                EXPECT_EQ(int{places_.at(there)}, int{images[places_.at(place)]})
                    << "image of " << place.transpose();
            }
        }
    }

    // At the planes of the normal an object goes on where it may and ends where it has to.
    void expect_dimension(const Constraint& constraint, const DimensionRule& rule, Chance& chance)
        const {
        const ObjectId object = objects_of(constraint, example_).front();
        const Point normal = Point(rule.normal[0], rule.normal[1], rule.normal[2]).normalized();
        const auto family = *problem_.reading->topes().find_family(normal);
        const double spacing = problem_.spacings.of_family[family];
        const Eigen::AlignedBox3d box = places_.set().frame().clip;
        const PlaneOffsets& planes = problem_.arrangement.planes(family);
        const double from_origin = planes.empty() ? 0 : planes.front() / spacing;
        if (std::abs(from_origin - std::round(from_origin)) > 1e-6) {
            return;  // they pass through the middle of a symmetric model, not the origin
        }
        for (int i = 0; i < 400; ++i) {
            const Point share(chance.share(), chance.share(), chance.share());
            Point place = box.min() + share.cwiseProduct(box.sizes());
            const auto plane = std::llround(normal.dot(place) / spacing);
            place += (static_cast<double>(plane) * spacing - normal.dot(place)) * normal;
            const Point step = 1e-4 * normal;
            // Below y = 0 the ground stands for good at the model's border.
            if (!box.contains(place + 2 * step) || !box.contains(place - 2 * step) ||
                place.y() < 0) {
                continue;
            }
            const bool is_above = places_.at(place + step) == object;
            const bool is_below = places_.at(place - step) == object;
            if (plane % rule.spacings == 0) {
                EXPECT_FALSE(is_above && is_below) << "goes on at " << place.transpose();
            } else {
                EXPECT_EQ(is_above, is_below) << "ends at " << place.transpose();
            }
        }
    }

    const Problem& problem_;
    const Example& example_;
    const Parameters& parameters_;
    SolidPlaces places_;
};

std::string text(const std::vector<std::string>& faults) {
    std::string all;
    for (const std::string& fault : faults) {
        all += fault + "\n";
    }
    return all;
}

// Whether planes along the axes are one spacing apart, so that regions of cells follow them.
bool has_axes(const Problem& problem, double spacing) {
    for (int axis = 0; axis < 3; ++axis) {
        const auto family = problem.reading->topes().find_family(Point::Unit(axis));
        if (!family || std::abs(problem.spacings.of_family[*family] - spacing) > 1e-9) {
            return false;
        }
    }
    return true;
}

// What is counted while one block after the other changes is what there is.
void expect_counted(
    const Problem& problem, const Parameters& parameters, const RecordingObserver& observer
) {
    if (problem.connections.empty() || observer.reports.empty()) {
        return;
    }
    std::vector<Connection> free = problem.connections;
    std::vector<std::vector<ObjectId>> objects;
    for (const Constraint& constraint : *parameters.constraints) {
        if (std::holds_alternative<ConnectedRule>(constraint.rule)) {
            objects.push_back(objects_of(constraint, problem.reading->example()));
        }
    }
    for (Connection& connection : free) {
        connection.components = 1'000'000;
    }
    const Skeleton skeleton(problem.arrangement);
    Connections followed(problem.reading->figures(), skeleton, free);
    Connections anew(problem.reading->figures(), skeleton, free);
    followed.start(observer.initial_model);
    for (std::size_t i = 0; i < observer.models.size(); ++i) {
        std::vector<Site> changed;
        problem.arrangement.for_each_vertex(observer.reports[i].region, [&](Site site) {
            changed.push_back(site);
        });
        followed.enter(changed);
        ASSERT_TRUE(followed.accepts(observer.models[i]));
        anew.start(observer.models[i]);
        for (std::size_t c = 0; c < free.size(); ++c) {
            ASSERT_EQ(followed.components(c), anew.components(c)) << "after block " << i;
        }
        if (i + 1 == observer.models.size() || i % 16 == 0) {
            const Surface surface = make_surface(problem, observer.models[i]);
            const ModelLooker looker(problem, parameters, surface);
            for (std::size_t c = 0; c < free.size(); ++c) {
                const std::size_t pieces = looker.places().pieces(objects[c]);
                EXPECT_EQ(pieces, anew.components(c)) << "after block " << i;
            }
        }
    }
}

std::string name_of(const ::testing::TestParamInfo<SolidsKind>& tested) {
    constexpr std::array<const char*, testing::kSolidsKindCount> kNames = {
        "Boxes", "Wedges", "Tetrahedra", "Convex", "Slivers"};
    return kNames.at(static_cast<std::size_t>(tested.param));
}

// A box of a model is made anew as the whole was: what lies outside of it stays.
void expect_the_rest_kept(
    const Reading& reading,
    const Parameters& parameters,
    const MetreBox& box,
    const std::vector<Label>& labels,
    const ModelLooker& before,
    Chance& chance
) {
    const Origin origin = {*parameters.size, labels, {}, {box}};
    const auto problem = make_problem(reading, parameters, &origin);
    ASSERT_TRUE(problem) << problem.error().message;
    RecordingObserver observer;
    const auto made = synthesise(*problem, parameters, 77, observer, {});
    if (!made) {
        EXPECT_EQ(made.error().code, ErrorCode::kGaveUp) << made.error().message;
        return;
    }
    const Surface surface = make_surface(*problem, made->labels);
    const ModelLooker after(*problem, parameters, surface);
    const Eigen::AlignedBox3d& clip = after.places().set().frame().clip;
    EXPECT_EQ(text(SurfaceChecker(with_images(*reading)).find_faults(surface, clip)), "");
    for (int i = 0; i < 300; ++i) {
        const Point share(chance.share(), chance.share(), chance.share());
        const Point place = clip.min() + share.cwiseProduct(clip.sizes());
        // What is sunk into the ground belongs to what is above.
        const std::array<double, 3> at = {place.x(), std::max(place.y(), 0.0), place.z()};
        bool is_outside = false;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            is_outside = is_outside || at[axis] < box.min[axis] || at[axis] > box.max[axis];
        }
        if (is_outside) {
            EXPECT_EQ(int{after.places().at(place)}, int{before.places().at(place)})
                << place.transpose();
        }
    }
    for (const Constraint& constraint : *parameters.constraints) {
        if (!has_region(constraint.rule) || has_axes(*problem, *parameters.spacing)) {
            after.expect_kept(constraint, chance);
        }
    }
}

// What came of one random request.
enum class Ending : std::uint8_t { kModel, kContradiction, kGaveUp, kNoModel };

Ending expect_constraints_hold(const Reading& plain, std::uint64_t seed, int extent_max) {
    RequestMaker maker(*plain, seed + 1000, extent_max);
    Parameters parameters = maker.make();
    auto read = ExampleReading::read_for(plain, parameters);
    while (!read || !find_faults(**read, parameters).empty()) {  // symmetries that cannot be
        parameters = maker.make();
        read = ExampleReading::read_for(plain, parameters);
    }
    const Reading& reading = *read;
    const auto problem = make_problem(reading, parameters);
    if (!problem) {
        const ErrorCode code = problem.error().code;
        // Planes that nearly meet are no matter of constraints.
        EXPECT_TRUE(
            code == ErrorCode::kContradiction || code == ErrorCode::kGaveUp ||
            code == ErrorCode::kInvalidArgument
        ) << problem.error().message;
        return code == ErrorCode::kContradiction ? Ending::kContradiction
               : code == ErrorCode::kGaveUp      ? Ending::kGaveUp
                                                 : Ending::kNoModel;
    }
    RecordingObserver observer;
    const auto made = synthesise(*problem, parameters, seed, observer, {});
    expect_counted(*problem, parameters, observer);
    if (!made) {
        EXPECT_EQ(made.error().code, ErrorCode::kGaveUp) << made.error().message;
        return Ending::kGaveUp;
    }
    const Surface surface = make_surface(*problem, made->labels);
    const ModelLooker looker(*problem, parameters, surface);
    EXPECT_EQ(
        text(SurfaceChecker(with_images(*reading))
                 .find_faults(surface, looker.places().set().frame().clip)),
        ""
    );
    Chance chance(seed);
    for (const Constraint& constraint : *parameters.constraints) {
        SCOPED_TRACE(kRuleNames.at(constraint.rule.index()));
        if (!has_region(constraint.rule) || has_axes(*problem, *parameters.spacing)) {
            looker.expect_kept(constraint, chance);
        }
    }
    if (has_axes(*problem, *parameters.spacing)) {
        SCOPED_TRACE("made anew");
        expect_the_rest_kept(reading, parameters, maker.box(), made->labels, looker, chance);
    }
    return Ending::kModel;
}

class SolidConstraints : public ::testing::TestWithParam<SolidsKind> {};

TEST_P(SolidConstraints, HoldForWhateverIsMade) {
    std::array<std::size_t, 4> endings = {};
    for (std::uint64_t seed = 0; seed < solid_case_count(60); ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const auto reading =
            ExampleReading::make(make_random_solids(GetParam(), static_cast<std::uint32_t>(seed)));
        if (!reading || (*reading)->topes().family_count() > 7) {
            continue;
        }
        const int extent_max = (*reading)->topes().family_count() > 4 ? 4 : 6;
        const Ending ending = expect_constraints_hold(*reading, seed, extent_max);
        ++endings.at(static_cast<std::size_t>(ending));
    }
    if (testing::are_solid_cases_usual()) {
        EXPECT_GT(endings[static_cast<std::size_t>(Ending::kModel)], solid_case_count(10));
        EXPECT_GT(endings[static_cast<std::size_t>(Ending::kContradiction)], 0U);
    }
}

INSTANTIATE_TEST_SUITE_P(
    Kinds,
    SolidConstraints,
    ::testing::Values(
        SolidsKind::kBoxes, SolidsKind::kWedges, SolidsKind::kTetrahedra, SolidsKind::kConvex
    ),
    name_of
);

TEST(SolidConstraintsOfBuiltInExamples, HoldForWhateverIsMade) {
    std::array<std::size_t, 4> endings = {};
    for (const Reading& reading : examples::built_in_solids()) {
        if (reading->example().spacing != 1) {
            continue;  // requests here are in metres that are spacings
        }
        if (!reading->example().constraints.empty()) {
            continue;  // places here are looked up in grids of the model's size
        }
        for (std::uint64_t seed = 0; seed < solid_case_count(4); ++seed) {
            SCOPED_TRACE(reading->example().name + ", seed " + std::to_string(seed));
            const Ending ending = expect_constraints_hold(reading, seed, 8);
            ++endings.at(static_cast<std::size_t>(ending));
        }
    }
    if (testing::are_solid_cases_usual()) {
        EXPECT_GT(endings[static_cast<std::size_t>(Ending::kModel)], 10U);
    }
}

}  // namespace
}  // namespace modelsynth::continuous
