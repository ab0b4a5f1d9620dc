#include "solver/continuous/reading/figures.h"

#include <algorithm>
#include <string>
#include <utility>

namespace modelsynth::continuous {

Result<Figures> Figures::make(
    const Topes& topes, const std::vector<Figure>& seeds, std::size_t figures_max
) {
    constexpr std::size_t kBytesMax = std::size_t{1} << 30;  // looked at in all
    Figures made(topes);
    for (const Figure& seed : seeds) {
        made.add(seed);
    }
    const std::size_t headings = topes.heading_count();
    Figure next(topes.count(), '\0');
    for (std::size_t label = 0; label < made.count(); ++label) {
        if (made.count() > figures_max || label * headings * topes.count() > kBytesMax) {
            return tl::unexpected(Error{
                ErrorCode::kTooLarge,
                "the example has more than " + std::to_string(std::min(made.count(), figures_max)) +
                    " different vertex figures of faces in " +
                    std::to_string(topes.family_count()) + " directions"});
        }
        for (std::size_t heading = 0; heading < headings; ++heading) {
            const Figure& figure = *made.figures_[label];
            for (std::size_t tope = 0; tope < next.size(); ++tope) {
                next[tope] =
                    figure[topes.composed(static_cast<Heading>(heading), static_cast<Tope>(tope))];
            }
            made.along_.push_back(made.add(next));
        }
    }
    return made;
}

Label Figures::add(Figure figure) {
    const auto [at, is_new] =
        numbers_.try_emplace(std::move(figure), static_cast<Label>(figures_.size()));
    if (is_new) {
        check(figures_.size() < kLabelCountMax, "more figures than a label can number");
        figures_.push_back(&at->first);
        FamilySet relevant = 0;
        for (std::size_t tope = 0; tope < topes_.count(); ++tope) {
            for (std::size_t family = 0; family < topes_.family_count(); ++family) {
                const Tope beyond = topes_.across(static_cast<Tope>(tope), family);
                if (at->first[tope] != at->first[beyond]) {
                    relevant |= only(family);
                }
            }
        }
        relevant_.push_back(relevant);
    }
    return at->second;
}

Label Figures::find(const Figure& figure) const {
    const auto found = numbers_.find(figure);
    return found == numbers_.end() ? kNoLabel : found->second;
}

int rank_of(const Topes& topes, FamilySet families) {
    std::size_t first = topes.family_count();
    FamilySet line = 0;
    for (std::size_t family = 0; family < topes.family_count(); ++family) {
        if ((families >> family & 1) == 0) {
            continue;
        }
        if (first == topes.family_count()) {
            first = family;
        } else if (line == 0) {
            line = topes.lines()[topes.line_of(first, family)].families;
        } else if ((line >> family & 1) == 0) {
            return 3;
        }
    }
    return first == topes.family_count() ? 0 : line == 0 ? 1 : 2;
}

Figure uniform_figure(const Topes& topes, ObjectId object) {
    return Figure(topes.count(), static_cast<char>(object));
}

Figure face_figure(const Topes& topes, std::size_t family, ObjectId below, ObjectId above) {
    Figure figure(topes.count(), static_cast<char>(below));
    for (std::size_t tope = 0; tope < topes.count(); ++tope) {
        if ((topes.sides(static_cast<Tope>(tope)) >> family & 1) != 0) {
            figure[tope] = static_cast<char>(above);
        }
    }
    return figure;
}

}  // namespace modelsynth::continuous
