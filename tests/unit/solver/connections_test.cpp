// How many components connected objects come in, counted while parts are made anew.

#include "solver/continuous/constraints/connections.h"

#include "solver/continuous/problem.h"
#include "solver/examples/solids/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <random>
#include <utility>
#include <vector>

namespace modelsynth::continuous {
namespace {

// A bar in space, and models of it that are 8 by 4 by 4 metres.
class ConnectionsOfBars : public ::testing::Test {
  protected:
    ConnectionsOfBars() : problem_(make_problem(read_bar(), parameters()).value()) {}

    // The model in which a bar reaches from each of these to the next, metres along x.
    [[nodiscard]] std::vector<Label> bars(const std::vector<std::pair<double, double>>& ends
    ) const {
        const auto object_at = [&](const Point& place) {
            const bool is_along = place.y() > 1 && place.y() < 2 && place.z() > 1 && place.z() < 2;
            return is_along && std::any_of(ends.begin(), ends.end(), [&](const auto& bar) {
                       return place.x() > bar.first && place.x() < bar.second;
                   });
        };
        const Topes& topes = problem_.reading->topes();
        std::vector<Label> labels;
        for (std::size_t v = 0; v < problem_.arrangement.vertex_count(); ++v) {
            Figure figure;
            for (std::size_t t = 0; t < topes.count(); ++t) {
                const Point place = problem_.arrangement.position(static_cast<Site>(v)) +
                                    0.1 * topes.inside(static_cast<Tope>(t));
                figure += static_cast<char>(object_at(place) ? 1 : kEmpty);
            }
            labels.push_back(problem_.reading->figures().find(figure));
            EXPECT_NE(labels.back(), kNoLabel);
        }
        return labels;
    }

    // The vertices from 2 to 6 metres along x.
    [[nodiscard]] std::vector<Site> middle() const {
        std::vector<Site> part;
        problem_.arrangement.for_each_vertex({{2, 0, 0}, {6, 4, 4}}, [&](Site site) {
            part.push_back(site);
        });
        return part;
    }

    [[nodiscard]] std::vector<Connection> connection(std::uint32_t components) const {
        LabelSet figures = LabelSet::all(problem_.reading->figures().count());
        figures.erase(
            problem_.reading->figures().find(uniform_figure(problem_.reading->topes(), kEmpty))
        );
        return {{figures, components}};
    }

    const Problem problem_;
    const Skeleton skeleton_{problem_.arrangement};
    const std::vector<Label> whole_ = bars({{1, 7}});
    const std::vector<Label> apart_ = bars({{1, 3}, {5, 7}});
    const std::vector<Label> none_ = bars({});

  private:
    static std::shared_ptr<const ExampleReading> read_bar() {
        Example example;
        example.name = "bar";
        example.materials = {{"bar", {}}};
        example.objects = {{"bar", 0}};
        example.polyhedra = {examples::box(1, {0, 0, 0}, {5, 1, 1})};
        return ExampleReading::make(std::move(example)).value();
    }

    static Parameters parameters() {
        Parameters parameters;
        parameters.size = {8, 4, 4};
        return fill_defaults(parameters, read_bar()->example());
    }
};

TEST_F(ConnectionsOfBars, RefuseWhatIsCutInTwo) {
    const auto asked = connection(1);
    Connections connections(problem_.reading->figures(), skeleton_, asked);
    connections.start(whole_);
    EXPECT_EQ(connections.components(0), 1U);
    connections.enter(middle());
    EXPECT_FALSE(connections.accepts(apart_));
    EXPECT_EQ(connections.components(0), 1U);
    // What stood before still does.
    connections.enter(middle());
    EXPECT_TRUE(connections.accepts(whole_));
    EXPECT_EQ(connections.components(0), 1U);
}

TEST_F(ConnectionsOfBars, TakeWhatMayComeInTwo) {
    const auto asked = connection(2);
    Connections connections(problem_.reading->figures(), skeleton_, asked);
    connections.start(whole_);
    connections.enter(middle());
    EXPECT_TRUE(connections.accepts(apart_));
    EXPECT_EQ(connections.components(0), 2U);
}

TEST_F(ConnectionsOfBars, TakeWhatJoinsMoreThanThereMayBe) {
    const auto asked = connection(1);
    Connections connections(problem_.reading->figures(), skeleton_, asked);
    connections.start(apart_);
    EXPECT_EQ(connections.components(0), 2U);
    connections.enter(middle());
    EXPECT_TRUE(connections.accepts(whole_));
    EXPECT_EQ(connections.components(0), 1U);
    connections.enter(middle());
    connections.take_back(apart_);
    EXPECT_EQ(connections.components(0), 2U);
}

TEST_F(ConnectionsOfBars, KnowWhatIsAllInside) {
    const auto asked = connection(1);
    Connections connections(problem_.reading->figures(), skeleton_, asked);
    connections.start(none_);
    EXPECT_EQ(connections.components(0), 0U);
    connections.enter(middle());
    EXPECT_TRUE(connections.accepts(bars({{3, 5}})));
    EXPECT_EQ(connections.components(0), 1U);
    connections.enter(middle());
    EXPECT_TRUE(connections.is_all_inside(0));
    connections.start(whole_);
    connections.enter(middle());
    EXPECT_FALSE(connections.is_all_inside(0));
}

// Bars anywhere, parts anywhere, what is accepted, refused and taken back: always as counted anew.
TEST_F(ConnectionsOfBars, CountAsWhoCountsAnew) {
    using Cells = std::array<bool, 8>;  // along x; none at the ends
    std::mt19937 random(1);
    const auto below = [&](std::uint32_t n) { return static_cast<std::size_t>(random() % n); };
    const auto model_of = [&](const Cells& cells) {
        std::vector<std::pair<double, double>> ends;
        for (std::size_t x = 0; x < cells.size(); ++x) {
            if (cells[x] && (x == 0 || !cells[x - 1])) {
                ends.emplace_back(x, x);
            }
            if (cells[x]) {
                ends.back().second += 1;
            }
        }
        return std::pair(bars(ends), static_cast<std::uint32_t>(ends.size()));
    };
    const auto asked = connection(2);
    Connections connections(problem_.reading->figures(), skeleton_, asked);
    Cells cells = {};
    connections.start(model_of(cells).first);
    std::uint32_t refused = 0;
    for (int step = 0; step < 200; ++step) {
        const std::uint32_t standing = model_of(cells).second;
        ASSERT_EQ(connections.components(0), standing) << step;
        const std::size_t west = below(7);
        const std::size_t east = west + 1 + below(static_cast<std::uint32_t>(8 - west));
        std::vector<Site> part;
        const Box box = {
            {static_cast<std::int32_t>(west), 0, 0}, {static_cast<std::int32_t>(east), 4, 4}};
        problem_.arrangement.for_each_vertex(box, [&](Site site) { part.push_back(site); });
        Cells next = cells;
        // Whose faces are both in the part.
        for (std::size_t x = std::max<std::size_t>(west, 1); x + 1 < east; ++x) {
            next[x] = below(2) != 0;
        }
        connections.enter(part);
        const auto [model, count] = model_of(next);
        if (step % 5 == 0) {
            connections.take_back(model);
            cells = next;
            continue;
        }
        const bool accepted = connections.accepts(model);
        EXPECT_EQ(accepted, count <= std::max(standing, 2U)) << step;
        cells = accepted ? next : cells;
        refused += accepted ? 0 : 1;
    }
    EXPECT_GT(refused, 0U);
}

}  // namespace
}  // namespace modelsynth::continuous
