#pragma once

#include "solver/core/catalog.h"
#include "solver/core/label_weights.h"
#include "solver/core/random.h"
#include "solver/core/search.h"
#include "solver/core/site_domains.h"
#include "solver/core/topology.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <span>
#include <stop_token>
#include <utility>
#include <vector>

namespace modelsynth {

enum class BlockOutcome : std::uint8_t {
    kAccepted,    // the block has new labels
    kReverted,    // every attempt failed; the block keeps its old labels
    kImpossible,  // proved: no labels fit (cannot happen when the old labels did)
    kStopped,     // the stop token was requested; the block keeps its old labels
};

struct BlockResult {
    BlockOutcome outcome = BlockOutcome::kReverted;
    std::uint32_t attempts = 0;
    Site impossible_site = 0;  // of the whole; where kImpossible was seen
};

struct BlockOptions {
    std::uint32_t attempts = 8;
    Order order = Order::kScan;
    std::span<const Site> scan;  // every site of the part once, the order of kScan
};

// What RandomKey::purpose says of the streams drawn here.
inline constexpr std::uint32_t kPurposeSearch = 1;

// What propagation makes of parts when nothing outside them is known: the domains alone. Many
// blocks of a model have the same one - all that touch the same sides - and it takes longer than
// the rest of their knowledge. Kept from block to block, it changes no result, only the time.
// Requires: one problem (relations and domains) for all calls. Not thread-safe.
template <class T>
class BlockBases {
  public:
    struct Base {
        T topology;
        std::vector<std::uint16_t> domains;
        std::vector<Word> sets;
    };

    // The state for such a part; null when none is kept.
    [[nodiscard]] const Base* find(const T& topology, std::span<const std::uint16_t> domains)
        const {
        const auto found = std::find_if(bases_.begin(), bases_.end(), [&](const Base& base) {
            return std::equal(
                       domains.begin(), domains.end(), base.domains.begin(), base.domains.end()
                   ) &&
                   base.topology == topology;
        });
        return found == bases_.end() ? nullptr : &*found;
    }

    // Forgets the oldest ones when memory would grow beyond the limit.
    void keep(Base base) {
        words_ += base.sets.size();
        bases_.push_back(std::move(base));
        while (words_ > kWordsMax || bases_.size() > kBasesMax) {
            words_ -= bases_.front().sets.size();
            bases_.erase(bases_.begin());
        }
    }

  private:
    // A block may touch each side of a model or not: 27 kinds in space. A few more for fixed cells.
    static constexpr std::size_t kBasesMax = 32;
    static constexpr std::size_t kWordsMax = std::size_t{1} << 20;

    std::vector<Base> bases_;
    std::size_t words_ = 0;  // of all sets together
};

// Runs searches over one part of a model while the rest stands still: the inner half of
// Algorithm 3.4. The knowledge that the surroundings force on the part is computed once; every
// attempt starts from it.
// Not thread-safe; make one per thread. Requires: all arguments outlive it.
template <TopologyPart Part, std::size_t kWords>
class BlockSearch {
  public:
    BlockSearch(
        const Part& part,
        const Relations& relations,
        const SiteDomains& domains,
        const LabelWeights& weights,
        BlockBases<typename Part::Inner>* bases
    )
        : part_(part),
          relations_(relations),
          domains_(domains),
          weights_(weights),
          bases_(bases),
          catalog_(part.inner(), relations) {}

    // Makes the part anew, or leaves `model` as it was.
    // Shape:    model has a label for every site of the whole; kNoLabel outside the part means
    //           "open": it puts no constraint on the part.
    // Requires: `key.attempt` and `key.purpose` zero; they are set here.
    [[nodiscard]] BlockResult modify(
        std::span<Label> model,
        const BlockOptions& options,
        RandomKey key,
        const std::stop_token& stop
    ) {
        BlockResult result;
        switch (surroundings(model, stop)) {
            case Propagation::kConsistent:
                break;
            case Propagation::kStopped:
                result.outcome = BlockOutcome::kStopped;
                return result;
            case Propagation::kContradiction:
                result.outcome = BlockOutcome::kImpossible;
                result.impossible_site = part_.global(impossible_);
                return result;
        }
        const std::vector<Word> start(catalog_.all_labels().begin(), catalog_.all_labels().end());
        for (result.attempts = 1; result.attempts <= options.attempts; ++result.attempts) {
            key.attempt = result.attempts;
            key.purpose = kPurposeSearch;
            RandomStream random(key);
            if (result.attempts > 1) {
                catalog_.restore(start);
            }
            const SearchOutcome outcome = run(options, random, stop);
            if (outcome == SearchOutcome::kStopped) {
                result.outcome = BlockOutcome::kStopped;
                return result;
            }
            if (outcome == SearchOutcome::kSolved) {
                write(model);
                result.outcome = BlockOutcome::kAccepted;
                return result;
            }
        }
        result.attempts = options.attempts;
        result.outcome = BlockOutcome::kReverted;
        return result;
    }

  private:
    // Everything the sites may be by themselves, less what the labels outside forbid.
    Propagation surroundings(std::span<const Label> model, const std::stop_token& stop) {
        Propagation propagation = base(stop);
        if (propagation != Propagation::kConsistent) {
            return propagation;
        }
        bool consistent = true;
        part_.for_each_outward_arc([&](Site inside, Site outside, RelationId relation) {
            const Label label = model[outside];
            if (consistent && label != kNoLabel) {
                const RelationId inward = relations_.reverse(relation);
                consistent = catalog_.narrow(inside, relations_.row(inward, label).data());
            }
        });
        propagation = consistent ? catalog_.propagate(stop) : Propagation::kContradiction;
        impossible_ = catalog_.emptied_site();
        return propagation;
    }

    // What the sites may be by themselves.
    Propagation base(const std::stop_token& stop) {
        std::vector<std::uint16_t> numbers(catalog_.site_count());
        for (std::size_t site = 0; site < numbers.size(); ++site) {
            numbers[site] = domains_.number(part_.global(static_cast<Site>(site)));
        }
        if (bases_ != nullptr) {
            if (const auto* known = bases_->find(part_.inner(), numbers)) {
                catalog_.restore(known->sets);
                return Propagation::kConsistent;
            }
        }
        std::vector<Word> sets(catalog_.all_labels().size());
        for (std::size_t site = 0; site < numbers.size(); ++site) {
            const std::span<const Word> own = domains_.words(part_.global(static_cast<Site>(site)));
            if (is_empty(own)) {
                impossible_ = static_cast<Site>(site);
                return Propagation::kContradiction;
            }
            std::copy(
                own.begin(),
                own.end(),
                sets.begin() + static_cast<std::ptrdiff_t>(site * catalog_.words())
            );
        }
        catalog_.restore(sets);
        catalog_.enqueue_all();
        const Propagation propagation = catalog_.propagate(stop);
        impossible_ = catalog_.emptied_site();
        if (bases_ != nullptr && propagation == Propagation::kConsistent) {
            std::copy(catalog_.all_labels().begin(), catalog_.all_labels().end(), sets.begin());
            bases_->keep({part_.inner(), std::move(numbers), std::move(sets)});
        }
        return propagation;
    }

    SearchOutcome run(
        const BlockOptions& options, RandomStream& random, const std::stop_token& stop
    ) {
        switch (options.order) {
            case Order::kScan: {
                ScanPicker picker(options.scan);
                return search(catalog_, picker, weights_, random, stop);
            }
            case Order::kRandom: {
                const std::vector<Site> shuffled = shuffle(random);
                ScanPicker picker(shuffled);
                return search(catalog_, picker, weights_, random, stop);
            }
            case Order::kMinEntropy: {
                EntropyPicker picker(catalog_, weights_, random);
                return search(catalog_, picker, weights_, random, stop);
            }
        }
        return SearchOutcome::kFailed;
    }

    std::vector<Site> shuffle(RandomStream& random) const {
        std::vector<Site> sites(catalog_.site_count());
        std::iota(sites.begin(), sites.end(), Site{0});
        for (std::size_t left = sites.size(); left > 1; --left) {
            std::swap(sites[left - 1], sites[random.below(static_cast<std::uint32_t>(left))]);
        }
        return sites;
    }

    void write(std::span<Label> model) const {
        for (std::size_t site = 0; site < catalog_.site_count(); ++site) {
            for_each_label(catalog_.labels(static_cast<Site>(site)), [&](Label label) {
                model[part_.global(static_cast<Site>(site))] = label;
            });
        }
    }

    const Part& part_;
    const Relations& relations_;
    const SiteDomains& domains_;
    const LabelWeights& weights_;
    BlockBases<typename Part::Inner>* bases_;  // null: none are kept
    Catalog<typename Part::Inner, kWords> catalog_;
    Site impossible_ = 0;  // where surroundings() found a contradiction
};

// One call of BlockSearch with the set width chosen at run time. `bases` saves work when many
// blocks of one problem are searched.
template <TopologyPart Part>
[[nodiscard]] BlockResult modify_block(
    const Part& part,
    const Relations& relations,
    const SiteDomains& domains,
    const LabelWeights& weights,
    std::span<Label> model,
    const BlockOptions& options,
    const RandomKey& key,
    const std::stop_token& stop,
    BlockBases<typename Part::Inner>* bases = nullptr
) {
    const auto with_width = [&]<std::size_t kWords>() {
        BlockSearch<Part, kWords> block(part, relations, domains, weights, bases);
        return block.modify(model, options, key, stop);
    };
    switch (relations.words()) {
        case 1:
            return with_width.template operator()<1>();
        case 2:
            return with_width.template operator()<2>();
        case 3:
            return with_width.template operator()<3>();
        case 4:
            return with_width.template operator()<4>();
        default:
            return with_width.template operator()<0>();
    }
}

}  // namespace modelsynth
