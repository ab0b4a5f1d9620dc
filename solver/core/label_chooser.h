#pragma once

#include "solver/core/label_set.h"
#include "solver/core/random.h"
#include "solver/core/site_weights.h"
#include "solver/core/topology.h"

#include <cstddef>
#include <span>
#include <vector>

namespace modelsynth {

// Chooses a label for a site by what is decided around it, where weights alone do not tell.
// Sites are numbered as in the whole. Thread-safe.
class LabelChooser {
  public:
    LabelChooser() = default;
    LabelChooser(const LabelChooser&) = delete;
    LabelChooser& operator=(const LabelChooser&) = delete;
    virtual ~LabelChooser() = default;

    // Replaces `around` with the sites that choose() wants to know of; kNoSite for none.
    virtual void look_around(Site site, std::vector<Site>& around) const = 0;

    // A label of the set, drawn at random.
    // Shape:    `decided` has the label of each site of `around`, kNoLabel where it is open.
    // Requires: the set is not empty.
    [[nodiscard]] virtual Label choose(
        std::span<const Word> possible,
        std::span<const Site> around,
        std::span<const Label> decided,
        const LabelWeights& weights,
        RandomStream& random
    ) const = 0;
};

// Asks a chooser for the sites of a part that is searched.
// Not thread-safe.
class PartChooser {
  public:
    explicit PartChooser(const LabelChooser& chooser) : chooser_(chooser) {}

    // The part is about to be searched, the rest of the model stands as it is.
    // Requires: the model outlives the search.
    template <TopologyPart Part>
    void enter(const Part& part, std::span<const Label> model) {
        inside_of_.assign(model.size(), kNoSite);
        whole_of_.clear();
        for_each_site(part, [this](Site inside, Site whole) {
            inside_of_[whole] = inside;
            whole_of_.push_back(whole);
        });
        model_ = model;
    }

    template <class CatalogType>
    [[nodiscard]] Label choose(
        const CatalogType& catalog, Site inside, const LabelWeights& weights, RandomStream& random
    ) {
        chooser_.look_around(whole_of_[inside], around_);
        decided_.clear();
        for (const Site site : around_) {
            decided_.push_back(site == kNoSite ? kNoLabel : decided(catalog, site));
        }
        return chooser_.choose(catalog.labels(inside), around_, decided_, weights, random);
    }

  private:
    template <class CatalogType>
    [[nodiscard]] Label decided(const CatalogType& catalog, Site whole) const {
        const Site inside = inside_of_[whole];
        if (inside == kNoSite) {
            return model_[whole];
        }
        Label label = kNoLabel;
        if (!has_several(catalog.labels(inside))) {
            for_each_label(catalog.labels(inside), [&label](Label only) { label = only; });
        }
        return label;
    }

    const LabelChooser& chooser_;
    std::vector<Site> inside_of_;  // by site of the whole; kNoSite outside the part
    std::vector<Site> whole_of_;
    std::span<const Label> model_;
    std::vector<Site> around_;
    std::vector<Label> decided_;
};

}  // namespace modelsynth
