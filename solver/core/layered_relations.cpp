#include "solver/core/layered_relations.h"

#include "solver/core/result.h"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

namespace modelsynth {

namespace {

constexpr std::size_t kUp = static_cast<std::size_t>(Direction::kUp);
constexpr std::size_t kDown = static_cast<std::size_t>(Direction::kDown);

// The labels that the sites of each layer can take by themselves.
std::vector<LabelSet> labels_of_layers(const SiteDomains& domains, const GridSize& size) {
    const auto layers = static_cast<std::size_t>(size.y);
    const std::size_t area = size.cell_count() / layers;
    const std::size_t label_count = domains.at(0).label_count();
    std::vector<LabelSet> labels(layers, LabelSet(label_count));
    for (std::size_t layer = 0; layer < layers; ++layer) {
        std::set<std::uint16_t> met;
        std::optional<std::uint16_t> last;
        domains.for_each_run(
            static_cast<Site>(layer * area),
            area,
            [&](std::size_t, std::size_t, std::uint16_t number) {
                if (last != number && met.insert(number).second) {
                    labels[layer] |= domains.set(number);
                }
                last = number;
            }
        );
    }
    return labels;
}

// Leaves the labels that some label of `from` allows along the relation; whether any went.
bool keep_allowed(
    LabelSet& labels, const LabelSet& from, const Relations& relations, std::size_t relation
) {
    LabelSet allowed(labels.label_count());
    for_each_label(from.words(), [&](Label label) {
        allowed.insert(relations.row(static_cast<RelationId>(relation), label));
    });
    const std::size_t before = labels.count();
    labels &= allowed;
    return labels.count() != before;
}

// Leaves what layers above and below allow.
void settle(std::vector<LabelSet>& layers, const Relations& relations) {
    for (bool has_changed = true; has_changed;) {
        has_changed = false;
        for (std::size_t layer = 1; layer < layers.size(); ++layer) {
            has_changed |= keep_allowed(layers[layer], layers[layer - 1], relations, kUp);
        }
        for (std::size_t layer = layers.size(); layer-- > 1;) {
            has_changed |= keep_allowed(layers[layer - 1], layers[layer], relations, kDown);
        }
    }
}

// Whether layers of these are of one kind: the same labels in them, and in those beside them.
bool are_alike(const std::vector<LabelSet>& layers, std::size_t a, std::size_t b) {
    const auto above = [&layers](std::size_t layer) {
        return layer + 1 < layers.size() ? &layers[layer + 1] : nullptr;
    };
    const auto below = [&layers](std::size_t layer) {
        return layer > 0 ? &layers[layer - 1] : nullptr;
    };
    const auto same = [](const LabelSet* one, const LabelSet* other) {
        return one == nullptr || other == nullptr ? one == other : *one == *other;
    };
    return layers[a] == layers[b] && same(above(a), above(b)) && same(below(a), below(b));
}

}  // namespace

std::unique_ptr<const LayeredRelations> LayeredRelations::make(
    const Relations& relations,
    const SiteDomains& domains,
    const SiteWeights& weights,
    const GridSize& size
) {
    if (relations.words() < 2 || relations.words() > kWholeWordsMax) {
        return nullptr;
    }
    std::vector<LabelSet> layers = labels_of_layers(domains, size);
    settle(layers, relations);
    std::unique_ptr<LayeredRelations> made(new LayeredRelations());
    made->area_ = static_cast<Site>(size.cell_count() / layers.size());
    std::vector<std::size_t> firsts;  // of each kind, one of its layers
    std::vector<LabelSet> sets;       // and its labels
    for (std::size_t layer = 0; layer < layers.size(); ++layer) {
        const auto found = std::find_if(firsts.begin(), firsts.end(), [&](std::size_t first) {
            return are_alike(layers, first, layer);
        });
        made->of_layer_.push_back(static_cast<std::uint8_t>(found - firsts.begin()));
        if (found == firsts.end()) {
            firsts.push_back(layer);
            sets.push_back(layers[layer]);
        }
        if (firsts.size() > LabelKinds::kCountMax || layers[layer].empty()) {
            return nullptr;
        }
    }
    made->kinds_ = LabelKinds(sets);
    const std::size_t words = made->words();
    made->group_bits_ = Relations::group_bits_for(words, kDirectionCount);
    made->stride_ = Relations::stride_for(kDirectionCount, words);
    const std::size_t table_words =
        (words * kWordBits / made->group_bits_ << made->group_bits_) * made->stride_;
    if (words >= relations.words() || words > kWordsMax ||
        weights.table_count() * sets.size() > kWeightTablesMax ||
        table_words * sets.size() > kTableWordsMax) {
        return nullptr;
    }
    made->unions_ = AlignedWords(table_words * sets.size());
    for (std::size_t kind = 0; kind < sets.size(); ++kind) {
        made->tables_.push_back(made->unions_.data() + kind * table_words);
        made->fill_table(firsts[kind], relations);
    }
    made->weights_.emplace(made->kinds_.numbered(weights));
    return made;
}

void LayeredRelations::fill_table(std::size_t layer, const Relations& relations) {
    const std::uint8_t kind = of_layer_[layer];
    const auto labels = kinds_.labels(kind);
    Word* const table = tables_[kind];
    for (std::size_t number = 0; number < labels.size(); ++number) {
        const std::size_t group = number / group_bits_;
        const std::size_t member = std::size_t{1} << (number % group_bits_);
        Word* const row = table + (group << group_bits_ | member) * stride_;
        for (std::size_t direction = 0; direction < kDirectionCount; ++direction) {
            const std::size_t beside =
                layer + static_cast<std::size_t>(std::int64_t{kDirectionSteps[direction].y});
            if (beside < of_layer_.size()) {
                const auto relation = static_cast<RelationId>(direction);
                kinds_.put_numbered(
                    of_layer_[beside],
                    relations.row(relation, labels[number]),
                    row + direction * words()
                );
            }
        }
    }
    add_up_unions(table, labels.size(), group_bits_, stride_);
}

}  // namespace modelsynth
