#include "solver/discrete/faults.h"
#include "solver/discrete/problem.h"
#include "solver/discrete/scene.h"
#include "solver/discrete/synthesis.h"
#include "solver/examples/built_in.h"
#include "tests/support/consistency_checker.h"
#include "tests/support/examples.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace modelsynth::discrete {
namespace {

using testing::find_inconsistency;
using testing::make_example;
using testing::make_pillars;
using testing::RecordingObserver;

Parameters sized(const Example& example, const GridSize& size) {
    Parameters parameters;
    parameters.size = size;
    return fill_defaults(parameters, example);
}

// Pillars whose bottom is ground and whose top is air, so that there is something to change.
Example make_grounded_pillars() {
    Example example = make_pillars();
    example.empty = 1;
    example.boundary[static_cast<std::size_t>(Direction::kDown)] = {BoundaryKind::kPieces, {"a"}};
    example.boundary[static_cast<std::size_t>(Direction::kUp)] = {BoundaryKind::kPieces, {"b"}};
    return example;
}

TEST(Transitions, AreThePairsOfTheExampleAndNoOthers) {
    // a b
    // a a   (rows from north to south)
    const Example example = make_example({2, 1, 2}, {0, 1, 0, 0}, 2);
    const Relations relations = find_transitions(example);
    const auto east = static_cast<RelationId>(Direction::kEast);
    const auto west = static_cast<RelationId>(Direction::kWest);
    const auto south = static_cast<RelationId>(Direction::kSouth);
    const auto up = static_cast<RelationId>(Direction::kUp);
    EXPECT_TRUE(relations.allows(east, 0, 1));
    EXPECT_TRUE(relations.allows(east, 0, 0));
    EXPECT_FALSE(relations.allows(east, 1, 0));
    EXPECT_FALSE(relations.allows(east, 1, 1));
    EXPECT_TRUE(relations.allows(west, 1, 0));
    EXPECT_FALSE(relations.allows(west, 0, 1));
    EXPECT_TRUE(relations.allows(south, 1, 0));
    EXPECT_FALSE(relations.allows(south, 0, 1));
    EXPECT_FALSE(relations.allows(up, 0, 0));
}

TEST(Transitions, ListedPairsAreAdded) {
    Example example = make_example({0, 0, 0}, {}, 2);
    example.adjacency = {{1, 0, 1}};
    const Relations relations = find_transitions(example);
    EXPECT_TRUE(relations.allows(static_cast<RelationId>(Direction::kUp), 0, 1));
    EXPECT_TRUE(relations.allows(static_cast<RelationId>(Direction::kDown), 1, 0));
    EXPECT_FALSE(relations.allows(static_cast<RelationId>(Direction::kUp), 1, 0));
}

TEST(Synthesis, ReportsBlocksInOrderAndEveryStateIsConsistent) {
    const Example example = make_grounded_pillars();
    RecordingObserver observer;
    const auto model = synthesise(example, sized(example, {17, 6, 13}), 5, observer, {});
    ASSERT_TRUE(model) << model.error().message;
    ASSERT_EQ(observer.reports.size(), observer.total);
    EXPECT_FALSE(find_inconsistency(example, {17, 6, 13}, observer.initial_model));
    for (std::size_t i = 0; i < observer.models.size(); ++i) {
        EXPECT_EQ(observer.reports[i].index, i);
        EXPECT_EQ(find_inconsistency(example, {17, 6, 13}, observer.models[i]), std::nullopt);
    }
    EXPECT_EQ(observer.models.back(), model->labels);
    EXPECT_GT(model->stats.changed, 0.0);
    EXPECT_EQ(
        model->stats.blocks.accepted() + model->stats.blocks.reverted, observer.reports.size()
    );
}

TEST(Synthesis, GoesOnFromACheckpointAfterAnyBlockToTheSameEnd) {
    const Example example = make_grounded_pillars();
    const Parameters parameters = sized(example, {17, 6, 13});
    RecordingObserver whole;
    const auto model = synthesise(example, parameters, 5, whole, {});
    ASSERT_TRUE(model);
    for (std::size_t block = 0; block < whole.reports.size(); ++block) {
        const Checkpoint checkpoint = {
            whole.reports[block].index + 1, whole.reports[block].tally, whole.models[block]};
        RecordingObserver rest;
        const auto resumed = synthesise(example, parameters, 5, rest, {}, &checkpoint);
        ASSERT_TRUE(resumed);
        EXPECT_EQ(rest.initial_model, checkpoint.labels);
        EXPECT_EQ(resumed->labels, model->labels);
        EXPECT_EQ(resumed->stats.blocks, model->stats.blocks);
        EXPECT_EQ(resumed->stats.changed, model->stats.changed);
        ASSERT_EQ(rest.reports.size(), whole.reports.size() - block - 1);
        if (!rest.reports.empty()) {
            EXPECT_EQ(rest.reports.front().index, block + 1);
        }
    }
}

TEST(Synthesis, GoesOnFromTheOneBlockOfAWhole) {
    const Example example = make_grounded_pillars();
    Parameters parameters = sized(example, {8, 4, 8});
    parameters.blocks = std::optional<Blocks>();
    RecordingObserver whole;
    const auto model = synthesise(example, parameters, 5, whole, {});
    ASSERT_TRUE(model);
    const Checkpoint checkpoint = {1, whole.reports.front().tally, model->labels};
    RecordingObserver rest;
    const auto resumed = synthesise(example, parameters, 5, rest, {}, &checkpoint);
    ASSERT_TRUE(resumed);
    EXPECT_EQ(resumed->labels, model->labels);
    EXPECT_TRUE(rest.reports.empty());
}

TEST(Synthesis, BlocksChangeOnlyTheirRegion) {
    const Example example = make_pillars();
    RecordingObserver observer;
    const GridSize size = {20, 5, 20};
    ASSERT_TRUE(synthesise(example, sized(example, size), 9, observer, {}));
    std::vector<Label> before = observer.initial_model;
    for (std::size_t i = 0; i < observer.models.size(); ++i) {
        for (std::size_t site = 0; site < before.size(); ++site) {
            if (!observer.reports[i].region.contains(size.cell(site))) {
                ASSERT_EQ(before[site], observer.models[i][site]);
            }
        }
        before = observer.models[i];
    }
}

TEST(Synthesis, HoldsBoundariesFixedCellsAndForbiddenPieces) {
    Example example = make_pillars();
    Parameters parameters;
    parameters.size = GridSize{12, 5, 12};
    auto& bottom = parameters.boundary[static_cast<std::size_t>(Direction::kDown)];
    auto& top = parameters.boundary[static_cast<std::size_t>(Direction::kUp)];
    bottom = SideBoundary{BoundaryKind::kPieces, {"a"}};
    top = SideBoundary{BoundaryKind::kPieces, {"b"}};
    parameters.constraints = {
        {Fixed{}, {"c"}, {.cells = {{3, 1, 4}, {8, 1, 8}}}},
        {Forbidden{}, {"c"}, {.box = Box{{0, 0, 0}, {2, 5, 12}}}}};
    parameters = fill_defaults(parameters, example);
    RecordingObserver observer;
    const auto model = synthesise(example, parameters, 1, observer, {});
    ASSERT_TRUE(model) << model.error().message;
    EXPECT_EQ(find_inconsistency(example, model->size, model->labels), std::nullopt);
    for_each_cell(Box::whole(model->size), [&](const Cell& cell) {
        const Label label = model->labels[model->size.index(cell)];
        if (cell.y == 0) {
            EXPECT_EQ(label, 0);
        }
        if (cell.y == 4) {
            EXPECT_EQ(label, 1);
        }
        if (cell.x < 2) {
            EXPECT_NE(label, 2);
        }
    });
    EXPECT_EQ(model->labels[model->size.index({3, 1, 4})], 2);
    EXPECT_EQ(model->labels[model->size.index({8, 1, 8})], 2);
}

TEST(Synthesis, WeightsMoveTheSharesAndZeroRemoves) {
    const Example example = make_grounded_pillars();
    const auto count_pillars = [&](double weight) {
        Parameters parameters = sized(example, {20, 4, 20});
        parameters.weights = WeightList{{"c", weight}};
        RecordingObserver observer;
        const auto model = synthesise(example, parameters, 2, observer, {});
        EXPECT_TRUE(model);
        return std::count(model->labels.begin(), model->labels.end(), 2);
    };
    EXPECT_EQ(count_pillars(0), 0);
    EXPECT_GT(count_pillars(100), 2 * count_pillars(0.02));
}

TEST(Synthesis, MakesAModelWhereNoPieceIsItsOwnNeighbour) {
    // A checkerboard: the only models are checkerboards.
    const Example example = make_example({3, 1, 3}, {0, 1, 0, 1, 0, 1, 0, 1, 0}, 2);
    RecordingObserver observer;
    const auto model = synthesise(example, sized(example, {11, 1, 8}), 3, observer, {});
    ASSERT_TRUE(model) << model.error().message;
    EXPECT_EQ(find_inconsistency(example, model->size, model->labels), std::nullopt);
}

TEST(Synthesis, SaysWhatNoModelCanHave) {
    // Nothing repeats: only the example itself is a model.
    const Example example = make_example({2, 1, 2}, {0, 1, 2, 3}, 4);
    RecordingObserver observer;
    EXPECT_TRUE(synthesise(example, sized(example, {2, 1, 2}), 0, observer, {}));
    const auto larger = synthesise(example, sized(example, {3, 1, 2}), 0, observer, {});
    ASSERT_FALSE(larger);
    EXPECT_EQ(larger.error().code, ErrorCode::kContradiction);
    EXPECT_NE(larger.error().message.find("\"a\""), std::string::npos) << larger.error().message;
}

TEST(Synthesis, NamesTheSidesOfAnImpossibleBoundary) {
    const Example example = make_pillars();
    Parameters parameters;
    parameters.size = GridSize{6, 4, 6};
    parameters.boundary[static_cast<std::size_t>(Direction::kDown)] =
        SideBoundary{BoundaryKind::kPieces, {"a"}};
    parameters.boundary[static_cast<std::size_t>(Direction::kNorth)] =
        SideBoundary{BoundaryKind::kPieces, {"b"}};
    RecordingObserver observer;
    const auto model = synthesise(example, fill_defaults(parameters, example), 0, observer, {});
    ASSERT_FALSE(model);
    EXPECT_EQ(model.error().code, ErrorCode::kContradiction);
    EXPECT_NE(model.error().message.find("bottom"), std::string::npos) << model.error().message;
    EXPECT_NE(model.error().message.find("north"), std::string::npos) << model.error().message;
    EXPECT_EQ(observer.total, 0U);  // nothing was begun
}

TEST(Synthesis, StopsWhenAsked) {
    const Example example = make_pillars();
    std::stop_source stop;

    class StopAfterThree final : public Observer {
      public:
        explicit StopAfterThree(std::stop_source& source) : source_(source) {}

        void on_start(std::uint32_t, std::span<const Label>) override {}

        void on_block(const BlockReport&) override {
            if (++blocks == 3) {
                source_.request_stop();
            }
        }

        int blocks = 0;

      private:
        std::stop_source& source_;
    } observer(stop);

    const auto model =
        synthesise(example, sized(example, {60, 4, 60}), 0, observer, stop.get_token());
    ASSERT_FALSE(model);
    EXPECT_EQ(model.error().code, ErrorCode::kCancelled);
    EXPECT_EQ(observer.blocks, 3);
}

TEST(FindFaults, NamesEveryUnknownPieceWithItsPlace) {
    const Example example = make_pillars();
    Parameters parameters;
    parameters.size = GridSize{6, 4, 6};
    parameters.boundary[static_cast<std::size_t>(Direction::kUp)] =
        SideBoundary{BoundaryKind::kPieces, {"b", "x"}};
    parameters.boundary[static_cast<std::size_t>(Direction::kEast)] =
        SideBoundary{BoundaryKind::kPeriodic, {}};
    parameters.weights = WeightList{{"a/b~", 2}};
    parameters.constraints = {
        {Fixed{}, {"y"}, {.box = Box{{0, 0, 0}, {7, 1, 1}}, .cells = {{0, 4, 0}}}}};
    std::vector<std::string> pointers;
    for (const Fault& fault : find_faults(example, fill_defaults(parameters, example))) {
        pointers.push_back(fault.pointer);
    }
    EXPECT_EQ(
        pointers,
        (std::vector<std::string>{
            "/boundary/east",
            "/boundary/top/1",
            "/weights/a~1b~0",
            "/constraints/0/pieces/0",
            "/constraints/0/box",
            "/constraints/0/cells/0"})
    );
}

TEST(BuiltIn, EachTeachesAndIsConsistentWithItself) {
    std::vector<std::string> names;
    for (const auto& example : examples::built_in()) {
        names.push_back(example->name);
        EXPECT_GE(example->pieces.size(), example->name == "city" ? 60U : 40U) << example->name;
        std::size_t triangles = 0;
        for (const Mesh& mesh : example->kit->meshes) {
            EXPECT_FALSE(mesh.primitives.empty()) << example->name << " " << mesh.name;
            for (const Primitive& primitive : mesh.primitives) {
                triangles += primitive.indices.size() / 3;
            }
        }
        EXPECT_LT(triangles, 25'000U) << example->name;
        std::vector<std::size_t> counts(example->pieces.size());
        for (const Label label : example->cells) {
            ++counts[label];
        }
        EXPECT_EQ(std::count(counts.begin(), counts.end(), 0U), 0) << example->name;
        EXPECT_LE(
            std::count(counts.begin(), counts.end(), 1U),
            static_cast<std::ptrdiff_t>(counts.size() / 10)
        ) << example->name;
    }
    EXPECT_EQ(names, (std::vector<std::string>{"castle", "city", "canyon"}));
}

TEST(BuiltIn, EachGivesLivelyModelsWithFewRevertedBlocks) {
    for (const auto& example : examples::built_in()) {
        for (const std::uint64_t seed : {1U, 2U}) {
            const GridSize size = {30, example->default_size.y, 30};
            RecordingObserver observer;
            const auto model = synthesise(*example, sized(*example, size), seed, observer, {});
            ASSERT_TRUE(model) << example->name << ": " << model.error().message;
            EXPECT_EQ(find_inconsistency(*example, size, model->labels), std::nullopt);
            EXPECT_LE(model->stats.blocks.reverted * 10, observer.total) << example->name;
            EXPECT_GE(model->stats.changed, 0.08) << example->name;
        }
    }
}

TEST(Scene, PlacesEveryDrawnCellInTheMiddleOfItsFloor) {
    Example example = make_pillars();
    example.cell = {2, 3, 4};
    for (Piece& piece : example.pieces) {
        piece.mesh = 0;
    }
    example.pieces[1].mesh.reset();
    const Scene scene = make_scene(example, example.size, example.cells, Box::whole(example.size));
    std::size_t instances = 0;
    for (const SceneGroup& group : scene.groups) {
        instances += group.instances.size();
    }
    EXPECT_EQ(instances, 11U);  // nine of ground, the pillar and its cap
    const Instance& first = scene.groups[0].instances[0];
    EXPECT_EQ(first.position, (Vec3{1, 0, 2}));
}

}  // namespace
}  // namespace modelsynth::discrete
