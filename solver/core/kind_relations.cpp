#include "solver/core/kind_relations.h"

#include <numeric>
#include <utility>

namespace modelsynth {

namespace {

bool is_subset(const LabelSet& set, const LabelSet& of) {
    LabelSet both = set;
    both &= of;
    return both == set;
}

}  // namespace

std::unique_ptr<const KindRelations> KindRelations::make(
    const Relations& relations,
    const SiteDomains& domains,
    const SiteWeights& weights,
    const GraphPart& sample
) {
    std::unique_ptr<KindRelations> made(new KindRelations());
    made->relation_count_ = relations.count();
    if (relations.words() < 2 || !made->find_kinds(domains) || made->words() >= relations.words() ||
        made->words() > kWordsMax ||
        weights.table_count() * made->kinds_.count() > kWeightTablesMax ||
        !made->place_rows(sample, domains)) {
        return nullptr;
    }
    for (std::size_t kind = 0; kind < made->kinds_.count(); ++kind) {
        made->fill_table(static_cast<std::uint8_t>(kind), relations);
    }
    made->weights_.emplace(made->kinds_.numbered(weights));
    return made;
}

// False when there are too many.
bool KindRelations::find_kinds(const SiteDomains& domains) {
    std::vector<std::uint8_t> is_used(domains.set_count());
    domains.for_each_run(0, domains.site_count(), [&](std::size_t, std::size_t, std::size_t set) {
        is_used[set] = 1;
    });
    std::vector<std::uint16_t> by_size;
    for (std::size_t set = 0; set < is_used.size(); ++set) {
        if (is_used[set] != 0) {
            by_size.push_back(static_cast<std::uint16_t>(set));
        }
    }
    std::stable_sort(by_size.begin(), by_size.end(), [&](std::uint16_t a, std::uint16_t b) {
        return domains.set(a).count() > domains.set(b).count();
    });
    std::vector<LabelSet> sets;
    of_domain_.resize(is_used.size());
    for (const std::uint16_t number : by_size) {
        // The smallest kind that holds it.
        const auto found = std::find_if(sets.rbegin(), sets.rend(), [&](const LabelSet& set) {
            return is_subset(domains.set(number), set);
        });
        of_domain_[number] = static_cast<std::uint8_t>(
            found == sets.rend() ? sets.size() : static_cast<std::size_t>(sets.rend() - found) - 1
        );
        if (found == sets.rend()) {
            sets.push_back(domains.set(number));
        }
        if (sets.size() > LabelKinds::kCountMax) {
            return false;
        }
    }
    kinds_ = LabelKinds(sets);
    for (std::size_t kind = 0; kind < kinds_.count(); ++kind) {
        words_of_.push_back(words_for(kinds_.labels(static_cast<std::uint8_t>(kind)).size()));
    }
    return true;
}

// False when there are too many.
bool KindRelations::place_rows(const GraphPart& sample, const SiteDomains& domains) {
    const std::size_t count = kinds_.count();
    const std::size_t places = relation_count_ * count;
    std::vector<std::uint32_t> looks(count * places);  // of the sample, along arcs of each place
    for (Site site = 0; site < sample.sites().size(); ++site) {
        const std::size_t kind = kind_at(sample.global(site), domains);
        sample.inner().for_each_arc(site, [&](Site far, RelationId relation) {
            ++looks[kind * places + place(relation, kind_at(sample.global(far), domains))];
        });
    }
    firsts_.resize(count * places);
    std::vector<std::size_t> begins;
    std::size_t total = 0;
    for (std::size_t kind = 0; kind < count; ++kind) {
        std::vector<std::size_t> order(places);
        std::iota(order.begin(), order.end(), kind * places);
        std::stable_sort(order.begin(), order.end(), [&looks](std::size_t a, std::size_t b) {
            return looks[a] > looks[b];
        });
        std::uint32_t stride = 0;
        for (const std::size_t at : order) {
            firsts_[at] = stride;
            stride += static_cast<std::uint32_t>(words_of_[at % count]);
        }
        begins.push_back(total);
        tables_.push_back({nullptr, stride, firsts_.data() + kind * places});
        const std::size_t labels = kinds_.labels(static_cast<std::uint8_t>(kind)).size();
        total += ((labels + kGroupBits - 1) / kGroupBits << kGroupBits) * stride;
    }
    if (total > kTableWordsMax) {
        return false;
    }
    unions_.resize(total + kWordsMax);  // who reads more words than there are stays inside
    for (std::size_t kind = 0; kind < count; ++kind) {
        tables_[kind].unions = unions_.data() + begins[kind];
    }
    return true;
}

void KindRelations::fill_table(std::uint8_t kind, const Relations& relations) {
    const Table& own = tables_[kind];
    const auto labels = kinds_.labels(kind);
    Word* const table = unions_.data() + (own.unions - unions_.data());
    std::vector<Word> allowed(words());
    for (std::size_t number = 0; number < labels.size(); ++number) {
        const std::size_t group = number / kGroupBits;
        const std::size_t member = std::size_t{1} << (number % kGroupBits);
        Word* const row = table + (group << kGroupBits | member) * own.stride;
        for (std::size_t r = 0; r < relation_count_; ++r) {
            const auto relation = static_cast<RelationId>(r);
            for (std::size_t k = 0; k < kinds_.count(); ++k) {
                const auto far = static_cast<std::uint8_t>(k);
                kinds_.put_numbered(far, relations.row(relation, labels[number]), allowed.data());
                std::copy_n(allowed.begin(), words_of(far), row + own.firsts[place(relation, far)]);
            }
        }
    }
    add_up_unions(table, labels.size(), kGroupBits, own.stride);
}

}  // namespace modelsynth
