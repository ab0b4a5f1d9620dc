#pragma once

#include "solver/core/growing_sets.h"
#include "solver/core/kind_relations.h"
#include "solver/core/label_set.h"
#include "solver/core/layered_relations.h"
#include "solver/core/relations.h"
#include "solver/core/site_domains.h"
#include "solver/core/site_weights.h"
#include "solver/core/topology.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace modelsynth {

// How a search numbers the labels of a part's sites, and what the problem says of them in those
// numbers. Sites inside the part and of the whole are told apart as `inside` and `whole`.

// As the problem does. Requires: its arguments outlive it.
template <TopologyPart Part>
class WholeNumbering {
  public:
    using RelationsOfSites = Relations;
    // Of sets of more than four, as Catalog knows them.
    static constexpr std::size_t kMoreWords = 0;

    WholeNumbering(
        const Relations& relations, const SiteDomains& domains, const SiteWeights& weights
    )
        : relations_(relations), domains_(domains), weights_(weights) {}

    [[nodiscard]] const Relations& relations() const { return relations_; }

    [[nodiscard]] const SiteDomains& domains() const { return domains_; }

    // From now on it is asked about that part. is_new_shape: no topology of before is equal.
    void enter(const Part& /*part*/, bool /*is_new_shape*/) {}

    // Appends what the numbers depend on beside the domains.
    void append_key(std::vector<std::uint16_t>& /*key*/) const {}

    // A set of the whole in the numbers of the site. Shape: `numbered` has relations().words().
    void put_numbered(Site /*inside*/, std::span<const Word> labels, Word* numbered) const {
        std::copy(labels.begin(), labels.end(), numbered);
    }

    // Sets of the whole.
    [[nodiscard]] GrowingSets growing(std::span<const LabelSet> sets) const {
        std::vector<Word> words;
        for (const LabelSet& set : sets) {
            words.insert(words.end(), set.words().begin(), set.words().end());
        }
        return {std::move(words), sets.size(), relations_.words(), nullptr};
    }

    // What the label at a site outside, as it is numbered in the whole, allows along an arc to a
    // site inside: `outward` is the arc's relation as seen from there. Good until the next call.
    [[nodiscard]] const Word* allowed(
        Site /*inside*/, Site /*outside*/, RelationId outward, Label label
    ) const {
        return relations_.row(relations_.reverse(outward), label).data();
    }

    // The label of the whole that is numbered so at the site.
    [[nodiscard]] Label label(Site /*inside*/, Label number) const { return number; }

    [[nodiscard]] PartWeights weights(const Part& part) {
        if (!weights_.is_same_everywhere()) {
            weight_numbers_.resize(part.inner().site_count());
            for_each_site(part, [&](Site inside, Site whole) {
                weight_numbers_[inside] = weights_.number(whole);
            });
        }
        return {weights_, weight_numbers_};
    }

  private:
    const Relations& relations_;
    const SiteDomains& domains_;
    const SiteWeights& weights_;
    std::vector<std::uint16_t> weight_numbers_;  // empty: the same everywhere
};

// Relations by kinds of sites, and of what kind the sites of a part are: for its catalog.
template <class KindedRelations>
class RelationsOfKinds {
  public:
    explicit RelationsOfKinds(const KindedRelations& relations) : relations_(relations) {}

    [[nodiscard]] const KindedRelations& by_kind() const { return relations_; }

    [[nodiscard]] std::size_t words() const { return relations_.words(); }

    [[nodiscard]] std::size_t count() const { return relations_.count(); }

    // By site inside.
    [[nodiscard]] const std::uint8_t* kinds() const { return kinds_.data(); }

    void resize(std::size_t site_count) { kinds_.resize(site_count); }

    void set(Site first, std::size_t count, std::uint8_t kind) {
        std::fill_n(kinds_.begin() + first, count, kind);
    }

  private:
    const KindedRelations& relations_;
    std::vector<std::uint8_t> kinds_;
};

// By kinds of sites. Requires: its arguments outlive it, and the first was made of the others.
template <TopologyPart Part, class KindedRelations>
class KindNumbering {
  public:
    using RelationsOfSites = RelationsOfKinds<KindedRelations>;
    static constexpr std::size_t kMoreWords = KindedRelations::kWordsMax;

    KindNumbering(
        const KindedRelations& by_kind,
        const Relations& relations,
        const SiteDomains& domains,
        const SiteWeights& weights
    )
        : by_kind_(by_kind),
          whole_(relations),
          domains_(domains),
          weights_(weights),
          sites_(by_kind),
          row_(by_kind.words()) {}

    [[nodiscard]] const RelationsOfSites& relations() const { return sites_; }

    [[nodiscard]] const SiteDomains& domains() const { return domains_; }

    void enter(const Part& part, bool is_new_shape) {
        if constexpr (kIsLayered) {
            // Equal shapes lie in equally many layers.
            const Site first = part.global(0);
            const std::size_t first_layer = by_kind_.layer(first);
            if (!is_new_shape && first_layer == first_layer_) {
                return;
            }
            first_layer_ = first_layer;
            kinds_of_layers_.clear();
        }
        sites_.resize(part.inner().site_count());
        part.for_each_run([&](Site inside, Site whole, std::size_t count) {
            if constexpr (kIsLayered) {
                const std::uint8_t kind = by_kind_.kind_at(whole, domains_);
                sites_.set(inside, count, kind);
                if (by_kind_.layer(whole) == first_layer_ + kinds_of_layers_.size()) {
                    kinds_of_layers_.push_back(kind);
                }
            } else {
                for (const Site end = whole + static_cast<Site>(count); whole != end; ++whole) {
                    sites_.set(inside++, 1, by_kind_.kind_at(whole, domains_));
                }
            }
        });
    }

    void append_key(std::vector<std::uint16_t>& key) const {
        key.insert(key.end(), kinds_of_layers_.begin(), kinds_of_layers_.end());
        key.push_back(kNumberedByKind);
    }

    void put_numbered(Site inside, std::span<const Word> labels, Word* numbered) const {
        by_kind_.kinds().put_numbered(sites_.kinds()[inside], labels, numbered);
    }

    [[nodiscard]] GrowingSets growing(std::span<const LabelSet> sets) const {
        const std::size_t words = by_kind_.words();
        std::vector<Word> all(sets.empty() ? 0 : by_kind_.kinds().count() * sets.size() * words);
        for (std::size_t kind = 0; !all.empty() && kind < by_kind_.kinds().count(); ++kind) {
            for (std::size_t i = 0; i < sets.size(); ++i) {
                by_kind_.kinds().put_numbered(
                    static_cast<std::uint8_t>(kind),
                    sets[i].words(),
                    all.data() + (kind * sets.size() + i) * words
                );
            }
        }
        return {std::move(all), sets.size(), words, sites_.kinds()};
    }

    [[nodiscard]] const Word* allowed(Site inside, Site outside, RelationId outward, Label label) {
        const RelationId inward = whole_.reverse(outward);
        const std::uint8_t kind = sites_.kinds()[inside];
        const std::uint8_t far_kind = by_kind_.kind_at(outside, domains_);
        const Label number = by_kind_.kinds().number(far_kind, label);
        if (number != kNoLabel) {
            by_kind_.put_row(far_kind, inward, kind, number, row_.data());
        } else {
            // It stands where no new one could.
            by_kind_.kinds().put_numbered(kind, whole_.row(inward, label), row_.data());
        }
        return row_.data();
    }

    [[nodiscard]] Label label(Site inside, Label number) const {
        return by_kind_.kinds().labels(sites_.kinds()[inside])[number];
    }

    [[nodiscard]] PartWeights weights(const Part& part) {
        weight_numbers_.resize(part.inner().site_count());
        if (weights_.is_same_everywhere()) {
            std::copy_n(sites_.kinds(), weight_numbers_.size(), weight_numbers_.begin());
        } else {
            for_each_site(part, [&](Site inside, Site whole) {
                const std::size_t first = weights_.number(whole) * by_kind_.kinds().count();
                weight_numbers_[inside] =
                    static_cast<std::uint16_t>(first + sites_.kinds()[inside]);
            });
        }
        return {by_kind_.weights(), weight_numbers_};
    }

  private:
    // Sets numbered as in the whole are never taken for these.
    static constexpr std::uint16_t kNumberedByKind = 0xFFFF;
    static constexpr bool kIsLayered = std::is_same_v<KindedRelations, LayeredRelations>;

    const KindedRelations& by_kind_;
    const Relations& whole_;
    const SiteDomains& domains_;
    const SiteWeights& weights_;
    RelationsOfSites sites_;
    std::vector<Word> row_;  // of allowed()
    std::vector<std::uint16_t> weight_numbers_;
    // Of a grid: the layer that the part's first site is in, and the kinds from there on. Of a
    // graph, kinds follow from the domains.
    std::size_t first_layer_ = 0;
    std::vector<std::uint16_t> kinds_of_layers_;
};

}  // namespace modelsynth
