#pragma once

#include "solver/core/graph_topology.h"
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
#include <span>
#include <vector>

namespace modelsynth {

// The relations of a graph, for labels numbered by kinds of sites. Sites are of a kind by what
// SiteDomains lets them take: of 264 figures of spaceships 28 to 146 can stand at a vertex,
// depending on the planes that meet there.
//
// A row holds what a label allows along each relation at sites of each kind, in as many words as
// that kind's sets have; those that are often looked at stand side by side.
// Cost: of making, O(relations * kinds * labels * labels); of memory, kTableWordsMax words.
// Thread-safe.
class KindRelations {
  public:
    // Of sets; as many as Catalog is compiled for.
    static constexpr std::size_t kWordsMax = 5;
    static constexpr std::size_t kGroupBits = 4;

    // Null where sets would not have fewer words, and where it would be too large to pay. Which
    // arcs are often looked at is seen in `sample`, some of the sites.
    [[nodiscard]] static std::unique_ptr<const KindRelations> make(
        const Relations& relations,
        const SiteDomains& domains,
        const SiteWeights& weights,
        const GraphPart& sample
    );

    KindRelations(const KindRelations&) = delete;
    KindRelations& operator=(const KindRelations&) = delete;

    [[nodiscard]] const LabelKinds& kinds() const { return kinds_; }

    // Requires: `domains` are those that it was made of.
    [[nodiscard]] std::uint8_t kind_at(Site site, const SiteDomains& domains) const {
        return of_domain_[domains.number(site)];
    }

    [[nodiscard]] std::size_t words() const { return kinds_.words(); }

    [[nodiscard]] std::size_t count() const { return relation_count_; }

    // What stands where in the rows of a kind.
    struct Table {
        const Word* unions = nullptr;  // as of Relations::union_data(), by nibbles
        std::size_t stride = 0;
        const std::uint32_t* firsts = nullptr;  // by relation and far kind: the first word
    };

    [[nodiscard]] const Table& table(std::uint8_t kind) const { return tables_[kind]; }

    // In a Table::firsts.
    [[nodiscard]] std::size_t place(RelationId relation, std::uint8_t far_kind) const {
        return relation * kinds_.count() + far_kind;
    }

    // Of sets at sites of the kind.
    [[nodiscard]] std::size_t words_of(std::uint8_t kind) const { return words_of_[kind]; }

    // What the label numbered so allows, in numbers of the far kind.
    void put_row(
        std::uint8_t kind, RelationId relation, std::uint8_t far_kind, Label number, Word* row
    ) const {
        const Table& own = tables_[kind];
        const std::size_t group = number / kGroupBits;
        const std::size_t member = std::size_t{1} << (number % kGroupBits);
        const Word* const from = own.unions + (group << kGroupBits | member) * own.stride +
                                 own.firsts[place(relation, far_kind)];
        std::fill_n(std::copy_n(from, words_of(far_kind), row), words() - words_of(far_kind), 0);
    }

    // As of LabelKinds::numbered().
    [[nodiscard]] const SiteWeights& weights() const { return *weights_; }

  private:
    static constexpr std::size_t kWeightTablesMax = 1024;
    static constexpr std::size_t kTableWordsMax = std::size_t{1} << 21;

    KindRelations() = default;

    [[nodiscard]] bool find_kinds(const SiteDomains& domains);
    [[nodiscard]] bool place_rows(const GraphPart& sample, const SiteDomains& domains);
    void fill_table(std::uint8_t kind, const Relations& relations);

    std::size_t relation_count_ = 0;
    std::vector<std::uint8_t> of_domain_;  // the kinds
    LabelKinds kinds_;
    std::vector<std::size_t> words_of_;
    std::vector<Word> unions_;
    std::vector<std::uint32_t> firsts_;
    std::vector<Table> tables_;
    std::optional<SiteWeights> weights_;
};

}  // namespace modelsynth
