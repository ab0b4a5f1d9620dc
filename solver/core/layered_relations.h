#pragma once

#include "solver/core/aligned_words.h"
#include "solver/core/grid.h"
#include "solver/core/label_kinds.h"
#include "solver/core/label_set.h"
#include "solver/core/relations.h"
#include "solver/core/site_domains.h"
#include "solver/core/site_weights.h"
#include "solver/core/topology.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace modelsynth {

// The relations of a grid, for labels numbered by layers: a label has a number where it can stand
// as far as the layers above and below tell. A city has 192 labels, of which at most 94 can stand
// in a layer. Layers are of one kind when the same labels can stand in them and in those beside
// them.
// Cost: of making, O(kinds * labels * labels); of memory, a table of unions as of Relations for
// each kind, kTableWordsMax words together. Thread-safe.
class LayeredRelations {
  public:
    // Of sets; as many as Catalog is compiled for.
    static constexpr std::size_t kWordsMax = 4;

    // Null where sets would not have fewer words, and where it would be too large to pay.
    // Shape: domains and weights have a site for each cell of the size. Requires: no arc of the
    // grid crosses a seam, and its relations are numbered as the directions.
    [[nodiscard]] static std::unique_ptr<const LayeredRelations> make(
        const Relations& relations,
        const SiteDomains& domains,
        const SiteWeights& weights,
        const GridSize& size
    );

    LayeredRelations(const LayeredRelations&) = delete;
    LayeredRelations& operator=(const LayeredRelations&) = delete;

    [[nodiscard]] const LabelKinds& kinds() const { return kinds_; }

    // The layer that a cell's site is in, from the ground up.
    [[nodiscard]] std::size_t layer(Site site) const { return site / area_; }

    [[nodiscard]] std::uint8_t kind_at(Site site, const SiteDomains& /*domains*/) const {
        return of_layer_[layer(site)];
    }

    [[nodiscard]] std::size_t words() const { return kinds_.words(); }

    [[nodiscard]] std::size_t count() const { return kDirectionCount; }

    // What the label numbered so allows, in numbers of the layer at the far end.
    void put_row(
        std::uint8_t kind, RelationId relation, std::uint8_t /*far_kind*/, Label number, Word* row
    ) const {
        const std::size_t group = number / group_bits_;
        const std::size_t member = std::size_t{1} << (number % group_bits_);
        const Word* const rows = tables_[kind] + (group << group_bits_ | member) * stride_;
        std::copy_n(rows + relation * words(), words(), row);
    }

    // By kind, its unions as of Relations::union_data().
    [[nodiscard]] const Word* const* tables() const { return tables_.data(); }

    // As of LabelKinds::numbered().
    [[nodiscard]] const SiteWeights& weights() const { return *weights_; }

  private:
    // Of so many labels too many can stand in some layer, and to find out takes long.
    static constexpr std::size_t kWholeWordsMax = 4 * kWordsMax;
    static constexpr std::size_t kWeightTablesMax = 1024;
    static constexpr std::size_t kTableWordsMax = std::size_t{1} << 19;

    LayeredRelations() = default;

    // That of the layer's kind.
    void fill_table(std::size_t layer, const Relations& relations);

    Site area_ = 1;                       // of a layer
    std::vector<std::uint8_t> of_layer_;  // the kinds
    LabelKinds kinds_;
    std::size_t group_bits_ = 0;
    std::size_t stride_ = 0;
    AlignedWords unions_;
    std::vector<Word*> tables_;  // in it, by kind
    std::optional<SiteWeights> weights_;
};

}  // namespace modelsynth
