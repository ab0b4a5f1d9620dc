// The catalog against a naive twin, over random sequences of operations.

#include "solver/core/catalog.h"

#include "solver/core/grid_topology.h"
#include "solver/core/random.h"
#include "solver/core/vector_level.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <set>
#include <utility>
#include <vector>

namespace modelsynth {
namespace {

// Domains as sets, arc consistency by repeated full sweeps.
class NaiveCatalog {
  public:
    NaiveCatalog(const GridTopology& grid, const Relations& relations)
        : grid_(grid), relations_(relations), sets_(grid.site_count()) {
        for (auto& set : sets_) {
            for (std::size_t label = 0; label < relations.label_count(); ++label) {
                set.insert(static_cast<Label>(label));
            }
        }
    }

    void keep_only(Site site, Label label) { sets_[site] = {label}; }

    void remove(Site site, Label label) { sets_[site].erase(label); }

    bool propagate() {
        bool changed = true;
        while (changed) {
            changed = false;
            for (Site site = 0; site < sets_.size(); ++site) {
                grid_.for_each_arc(site, [&](Site to, RelationId relation) {
                    changed = std::erase_if(
                                  sets_[to],
                                  [&](Label b) {
                                      return std::none_of(
                                          sets_[site].begin(),
                                          sets_[site].end(),
                                          [&](Label a) { return relations_.allows(relation, a, b); }
                                      );
                                  }
                              ) > 0 ||
                              changed;
                });
            }
        }
        return std::none_of(sets_.begin(), sets_.end(), [](const auto& s) { return s.empty(); });
    }

    std::vector<std::set<Label>> sets() const { return sets_; }

    void restore(std::vector<std::set<Label>> sets) { sets_ = std::move(sets); }

  private:
    const GridTopology& grid_;
    const Relations& relations_;
    std::vector<std::set<Label>> sets_;
};

template <std::size_t kWords>
void compare_with_naive(std::size_t label_count, std::uint64_t seed) {
    RandomStream random({seed, 0, 0, 1});
    const GridTopology grid({3, 2, 3}, {seed % 2 == 0, false, seed % 3 == 0});
    Relations relations(label_count, {1, 0, 3, 2, 5, 4});
    for (RelationId r = 0; r < 6; r += 2) {
        for (std::size_t pairs = 0; pairs < label_count * 3; ++pairs) {
            relations.allow(
                r,
                static_cast<Label>(random.below(static_cast<std::uint32_t>(label_count))),
                static_cast<Label>(random.below(static_cast<std::uint32_t>(label_count)))
            );
        }
    }
    Catalog<GridTopology, kWords> catalog(grid, relations);
    NaiveCatalog naive(grid, relations);
    catalog.fill(LabelSet::all(label_count).words());
    catalog.enqueue_all();
    const auto same = [&] {
        for (Site site = 0; site < grid.site_count(); ++site) {
            std::set<Label> labels;
            for_each_label(catalog.labels(site), [&](Label l) { labels.insert(l); });
            if (labels != naive.sets()[site]) {
                return false;
            }
        }
        return true;
    };
    const bool consistent = naive.propagate();
    ASSERT_EQ(catalog.propagate({}) == Propagation::kConsistent, consistent) << "seed " << seed;
    if (!consistent) {
        return;
    }

    struct Level {
        typename Catalog<GridTopology, kWords>::Mark mark;
        std::vector<std::set<Label>> sets;
    };

    std::vector<Level> levels;
    for (int step = 0; step < 40; ++step) {
        const std::uint32_t action = random.below(4);
        if (action == 0 && !levels.empty()) {
            catalog.undo(levels.back().mark);
            naive.restore(levels.back().sets);
            levels.pop_back();
        } else {
            const auto site =
                static_cast<Site>(random.below(static_cast<std::uint32_t>(grid.site_count())));
            const auto sets = naive.sets();
            const auto pick = random.below(static_cast<std::uint32_t>(sets[site].size()));
            const Label label = *std::next(sets[site].begin(), pick);
            levels.push_back({catalog.mark(), sets});
            bool left = true;
            if (action == 1) {
                left = catalog.remove(site, label);
                naive.remove(site, label);
            } else {
                catalog.assign(site, label);
                naive.keep_only(site, label);
            }
            const bool fine = naive.propagate();
            const bool own = left && catalog.propagate({}) == Propagation::kConsistent;
            ASSERT_EQ(own, fine) << "seed " << seed << " step " << step;
            if (!fine) {
                catalog.undo(levels.back().mark);
                naive.restore(levels.back().sets);
                levels.pop_back();
            }
        }
        ASSERT_TRUE(same()) << "seed " << seed << " step " << step;
    }
}

// Both forms of the inner loop, every width that is compiled, and the one for any width.
TEST(Catalog, AgreesWithANaiveTwinOverRandomAssignmentsRemovalsAndUndos) {
    for (const VectorLevel level : {VectorLevel::kPortable, VectorLevel::kAvx2}) {
        limit_vector_level(level);
        for (std::uint64_t seed = 0; seed < 60; ++seed) {
            compare_with_naive<1>(3 + seed % 9, seed);
            compare_with_naive<0>(3 + seed % 9, seed);
        }
        for (std::uint64_t seed = 0; seed < 8; ++seed) {  // the twin is slow
            compare_with_naive<1>(64, seed);
            compare_with_naive<2>(70, seed);
            compare_with_naive<3>(150, seed);
            compare_with_naive<4>(210, seed);
            compare_with_naive<0>(140, seed);
        }
    }
    limit_vector_level(VectorLevel::kAvx2);
}

}  // namespace
}  // namespace modelsynth
