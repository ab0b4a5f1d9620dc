#pragma once

#include "solver/core/catalog.h"
#include "solver/core/label_weights.h"
#include "solver/core/random.h"
#include "solver/core/search.h"
#include "solver/core/site_domains.h"
#include "solver/core/topology.h"

#include <cstdint>
#include <numeric>
#include <span>
#include <stop_token>
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
        const LabelWeights& weights
    )
        : part_(part),
          relations_(relations),
          domains_(domains),
          weights_(weights),
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
        std::vector<Word> sets(catalog_.all_labels().size());
        for (std::size_t site = 0; site < catalog_.site_count(); ++site) {
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
        bool consistent = true;
        part_.for_each_outward_arc([&](Site inside, Site outside, RelationId relation) {
            const Label label = model[outside];
            if (consistent && label != kNoLabel) {
                const RelationId inward = relations_.reverse(relation);
                consistent = catalog_.narrow(inside, relations_.row(inward, label).data());
            }
        });
        catalog_.enqueue_all();
        const Propagation propagation =
            consistent ? catalog_.propagate(stop) : Propagation::kContradiction;
        impossible_ = catalog_.emptied_site();
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
    Catalog<typename Part::Inner, kWords> catalog_;
    Site impossible_ = 0;  // where surroundings() found a contradiction
};

// One call of BlockSearch with the set width chosen at run time.
template <TopologyPart Part>
[[nodiscard]] BlockResult modify_block(
    const Part& part,
    const Relations& relations,
    const SiteDomains& domains,
    const LabelWeights& weights,
    std::span<Label> model,
    const BlockOptions& options,
    const RandomKey& key,
    const std::stop_token& stop
) {
    const auto with_width = [&]<std::size_t kWords>() {
        BlockSearch<Part, kWords> block(part, relations, domains, weights);
        return block.modify(model, options, key, stop);
    };
    switch (relations.words()) {
        case 1:
            return with_width.template operator()<1>();
        case 2:
            return with_width.template operator()<2>();
        default:
            return with_width.template operator()<0>();
    }
}

}  // namespace modelsynth
