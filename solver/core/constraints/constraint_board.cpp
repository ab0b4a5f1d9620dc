#include "solver/core/constraints/constraint_board.h"

#include <numeric>

namespace modelsynth {

void ConstraintBoard::add(
    const LabelSet& labels,
    std::vector<std::uint8_t> applies,
    std::unique_ptr<SetConstraint> constraint
) {
    check(
        applies.empty() || applies.size() == inside_of_.size(),
        "a constraint on sites of another model"
    );
    LabelSet others = LabelSet::all(labels.label_count());
    for_each_label(labels.words(), [&others](Label label) { others.erase(label); });
    entries_.push_back(
        {labels,
         std::move(others),
         std::move(applies),
         Members(inside_of_.size()),
         std::move(constraint),
         {}}
    );
}

void ConstraintBoard::start(std::span<const Label> model) {
    for (Entry& entry : entries_) {
        for (std::size_t site = 0; site < model.size(); ++site) {
            const auto whole = static_cast<Site>(site);
            entry.members.set(whole, membership(entry, whole, model[site]));
        }
    }
    forget_changes();
}

std::optional<std::size_t> ConstraintBoard::find_violated(std::span<const Label> model) {
    start(model);
    std::vector<Site> all(model.size());
    std::iota(all.begin(), all.end(), Site{0});
    for (std::size_t i = 0; i < entries_.size(); ++i) {
        Entry& entry = entries_[i];
        entry.constraint->enter(entry.members, all);
        conclusions_.clear();
        if (!entry.constraint->conclude(entry.members, all, conclusions_)) {
            return i;
        }
    }
    return std::nullopt;
}

void ConstraintBoard::leave(std::span<const Label> model) {
    for (Entry& entry : entries_) {
        for (const Site whole : inside_) {
            entry.members.set(whole, membership(entry, whole, model[whole]));
        }
    }
    for (const Site whole : inside_) {
        inside_of_[whole] = kOutside;
    }
    inside_.clear();
    forget_changes();
}

bool ConstraintBoard::conclude() {
    conclusions_.clear();
    for (std::size_t i = 0; i < entries_.size(); ++i) {
        Entry& entry = entries_[i];
        if (entry.changed.empty()) {
            continue;
        }
        const bool possible =
            entry.constraint->conclude(entry.members, entry.changed, conclusions_);
        entry.changed.clear();
        if (!possible || !conclusions_.empty()) {
            concluded_ = i;
            return possible;
        }
    }
    return true;
}

void ConstraintBoard::forget_changes() {
    for (Entry& entry : entries_) {
        entry.changed.clear();
    }
}

}  // namespace modelsynth
