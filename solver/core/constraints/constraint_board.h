#pragma once

#include "solver/core/catalog.h"
#include "solver/core/constraints/set_constraint.h"
#include "solver/core/label_set.h"
#include "solver/core/topology.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <utility>
#include <vector>

namespace modelsynth {

// Keeps the constraints of a model and what is decided for each, while one part after the other is
// made anew, and goes between them and the catalog of the part.
// Cost: four bytes a site, and one for each constraint.
// Thread-safety: one thread at a time.
class ConstraintBoard {
  public:
    explicit ConstraintBoard(std::size_t site_count) : inside_of_(site_count, kOutside) {}

    // The set: sites where `applies` (empty: all) whose label is in `labels`.
    // Cheap constraints come first: a later one is asked when the earlier have nothing to say.
    void add(
        const LabelSet& labels,
        std::vector<std::uint8_t> applies,
        std::unique_ptr<SetConstraint> constraint
    );

    [[nodiscard]] bool empty() const { return entries_.empty(); }

    // The number of the first constraint, in order of addition, that a complete model violates.
    // Afterwards the model stands, as of start().
    [[nodiscard]] std::optional<std::size_t> find_violated(std::span<const Label> model);

    // The model stands; parts of it are made anew from now on.
    void start(std::span<const Label> model);

    // The part is about to be made anew; leave() ends it.
    template <TopologyPart Part>
    void enter(const Part& part) {
        inside_.clear();
        for_each_site(part, [this](Site inside, Site whole) {
            inside_of_[whole] = inside;
            inside_.push_back(whole);
        });
    }

    // The part has these labels now, new ones or those of before.
    void leave(std::span<const Label> model);

    // After enter(): removes what the constraints forbid beside the state of the catalog, which
    // propagation left.
    template <class CatalogType>
    [[nodiscard]] Propagation begin(CatalogType& catalog, const std::stop_token& stop) {
        follow(catalog);
        for (Entry& entry : entries_) {
            entry.constraint->enter(entry.members, inside_);
            entry.changed = inside_;
        }
        return settle(catalog, stop);
    }

    // After begin() found a contradiction: the number of the constraint that it came of.
    [[nodiscard]] std::size_t blamed() const { return concluded_; }

    // The catalog was put back to what begin() left.
    template <class CatalogType>
    void resume(CatalogType& catalog) {
        follow(catalog);
        forget_changes();
    }

    // After a propagation that changed the catalog: until neither it nor a constraint has anything
    // to remove. The outcome as of Catalog::propagate().
    template <class CatalogType>
    [[nodiscard]] Propagation settle(CatalogType& catalog, const std::stop_token& stop) {
        for (;;) {
            if (stop.stop_requested()) {
                return Propagation::kStopped;
            }
            note(catalog, catalog.changed());
            if (!conclude()) {
                return Propagation::kContradiction;
            }
            if (conclusions_.empty()) {
                return Propagation::kConsistent;
            }
            if (!apply(catalog)) {
                return Propagation::kContradiction;
            }
            const Propagation propagation = catalog.propagate(stop);
            if (propagation != Propagation::kConsistent) {
                return propagation;
            }
        }
    }

    // Changes of the catalog were taken back, to a state that was settled.
    template <class CatalogType>
    void rewind(const CatalogType& catalog) {
        note(catalog, catalog.changed());
        forget_changes();
    }

  private:
    static constexpr Site kOutside = ~Site{0};

    struct Entry {
        LabelSet labels;
        LabelSet others;
        std::vector<std::uint8_t> applies;
        Members members;
        std::unique_ptr<SetConstraint> constraint;
        std::vector<Site> changed;
    };

    static Membership membership(const Entry& entry, Site whole, std::span<const Word> set) {
        if (!entry.applies.empty() && entry.applies[whole] == 0) {
            return Membership::kNo;
        }
        Word in = 0;
        Word out = 0;
        for (std::size_t word = 0; word < set.size(); ++word) {
            in |= set[word] & entry.labels.words()[word];
            out |= set[word] & entry.others.words()[word];
        }
        return in == 0 ? Membership::kNo : out == 0 ? Membership::kYes : Membership::kMaybe;
    }

    static Membership membership(const Entry& entry, Site whole, Label label) {
        const bool applies = entry.applies.empty() || entry.applies[whole] != 0;
        return applies && entry.labels.contains(label) ? Membership::kYes : Membership::kNo;
    }

    template <class CatalogType>
    void follow(CatalogType& catalog) {
        catalog.track_changes();
        catalog.clear_changed();
        for (Entry& entry : entries_) {
            for (std::size_t inside = 0; inside < inside_.size(); ++inside) {
                const auto labels = catalog.labels(static_cast<Site>(inside));
                entry.members.set(inside_[inside], membership(entry, inside_[inside], labels));
            }
        }
    }

    template <class CatalogType>
    void note(const CatalogType& catalog, std::span<const Site> changed) {
        for (Entry& entry : entries_) {
            for (const Site inside : changed) {
                const Site whole = inside_[inside];
                if (entry.members.set(whole, membership(entry, whole, catalog.labels(inside)))) {
                    entry.changed.push_back(whole);
                }
            }
        }
    }

    // Asks the constraints that have news until one has something to say.
    [[nodiscard]] bool conclude();

    void forget_changes();

    template <class CatalogType>
    [[nodiscard]] bool apply(CatalogType& catalog) {
        const Entry& entry = entries_[concluded_];
        for (const Site whole : conclusions_.always) {
            if (!catalog.narrow(inside_of_[whole], entry.labels.words().data())) {
                return false;
            }
        }
        for (const Site whole : conclusions_.never) {
            if (!catalog.narrow(inside_of_[whole], entry.others.words().data())) {
                return false;
            }
        }
        return true;
    }

    std::vector<Entry> entries_;
    std::vector<Site> inside_;     // of the part: the sites' numbers in the whole
    std::vector<Site> inside_of_;  // of the whole: the sites' numbers in the part, or kOutside
    Conclusions conclusions_;
    std::size_t concluded_ = 0;  // the entry that they are of, or that found a contradiction
};

}  // namespace modelsynth
