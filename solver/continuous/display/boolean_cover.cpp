#include "solver/continuous/display/boolean_cover.h"

#include "solver/core/result.h"

#include <algorithm>
#include <bit>
#include <bitset>
#include <optional>
#include <tuple>
#include <utility>

namespace modelsynth::continuous {

namespace {

// As many covers are kept as may differ once their common literals are taken out.
constexpr std::size_t kCoversMax = 8;

constexpr std::size_t kPointsMax = std::size_t{1} << kPrimesVariablesMax;
using Points = std::bitset<kPointsMax>;

// Takes the steps, or tells that there are not as many.
bool take(std::size_t& steps_left, std::size_t steps) {
    if (steps > steps_left) {
        steps_left = 0;
        return false;
    }
    steps_left -= steps;
    return true;
}

std::size_t literal_count(const Cube& cube) {
    return static_cast<std::size_t>(std::popcount(cube.variables));
}

// Literals, and the sign before each cube.
std::size_t cost_of(const Cover& cover) {
    std::size_t cost = 0;
    for (const Cube& cube : cover) {
        cost += literal_count(cube) + 1;
    }
    return cost;
}

// The cubes that hold at some point on and none off, and at some point off without any one of their
// literals. Sets of variables are gone through by number, so that smaller ones come first.
std::vector<Cube> prime_implicants(const PartialFunction& function) {
    const auto sets = std::uint32_t{1} << function.variables;
    const std::size_t count = function.on.size();
    std::vector<std::uint8_t> implies(sets * count, 0);
    std::vector<std::uint32_t> seen_off(sets, sets);  // the last set by which this was a point off
    std::vector<Cube> primes;
    for (std::uint32_t set = 0; set < sets; ++set) {
        for (const std::uint32_t point : function.off) {
            seen_off[point & set] = set;
        }
        for (std::size_t i = 0; i < count; ++i) {
            const std::uint32_t values = function.on[i] & set;
            if (seen_off[values] == set) {
                continue;
            }
            implies[set * count + i] = 1;
            bool is_prime = true;
            for (std::uint32_t rest = set; rest != 0; rest &= rest - 1) {
                const std::uint32_t fewer = set ^ (rest & (~rest + 1));
                is_prime = is_prime && implies[fewer * count + i] == 0;
            }
            if (is_prime) {
                primes.push_back({set, values});
            }
        }
    }
    std::sort(primes.begin(), primes.end());
    primes.erase(std::unique(primes.begin(), primes.end()), primes.end());
    return primes;
}

// The cubes without which all points on are covered, too, taken away.
void remove_idle(const std::vector<std::uint32_t>& on, Cover& cover) {
    std::vector<std::size_t> times(on.size(), 0);
    for (const Cube& cube : cover) {
        for (std::size_t i = 0; i < on.size(); ++i) {
            times[i] += cube.holds_at(on[i]) ? 1U : 0U;
        }
    }
    for (std::size_t c = cover.size(); c-- > 0;) {
        bool is_idle = true;
        for (std::size_t i = 0; i < on.size(); ++i) {
            is_idle = is_idle && (times[i] > 1 || !cover[c].holds_at(on[i]));
        }
        if (is_idle) {
            for (std::size_t i = 0; i < on.size(); ++i) {
                times[i] -= cover[c].holds_at(on[i]) ? 1U : 0U;
            }
            cover.erase(cover.begin() + static_cast<std::ptrdiff_t>(c));
        }
    }
}

// The cheapest sets of primes that cover all points on: branches at the point that the fewest
// primes cover.
class CoverSearch {
  public:
    explicit CoverSearch(const PartialFunction& function)
        : on_(function.on),
          primes_(prime_implicants(function)),
          of_point_(on_.size()),
          steps_(primes_.size() * on_.size()) {
        check(on_.size() <= kPointsMax, "more points than there are");
        for (const Cube& prime : primes_) {
            Points points;
            for (std::size_t i = 0; i < on_.size(); ++i) {
                points[i] = prime.holds_at(on_[i]);
            }
            for (std::size_t i = 0; i < on_.size(); ++i) {
                if (points[i]) {
                    of_point_[i].push_back(points_.size());
                }
            }
            points_.push_back(points);
        }
    }

    [[nodiscard]] std::vector<Cover> run() {
        Points open;
        for (std::size_t i = 0; i < on_.size(); ++i) {
            open.set(i);
        }
        Cover chosen;
        branch(open, 0, chosen);
        return std::move(found_);
    }

    [[nodiscard]] std::size_t steps() const { return steps_; }

  private:
    void branch(const Points& open, std::size_t cost, Cover& chosen) {
        if (open.none()) {
            keep(chosen);
            return;
        }
        if (++nodes_ > kCoverNodesMax && !found_.empty()) {
            return;
        }
        std::size_t rarest = on_.size();
        for (std::size_t i = 0; i < on_.size(); ++i) {
            if (open[i] &&
                (rarest == on_.size() || of_point_[i].size() < of_point_[rarest].size())) {
                rarest = i;
            }
        }
        std::vector<std::pair<std::size_t, std::size_t>> choices;  // points left open, prime
        for (const std::size_t prime : of_point_[rarest]) {
            choices.emplace_back((open & ~points_[prime]).count(), prime);
        }
        steps_ += on_.size() + choices.size() * kPointsMax / 16;
        std::sort(choices.begin(), choices.end(), [this](const auto& a, const auto& b) {
            return std::tuple(a.first, literal_count(primes_[a.second]), a.second) <
                   std::tuple(b.first, literal_count(primes_[b.second]), b.second);
        });
        for (const auto& choice : choices) {
            const Cube& prime = primes_[choice.second];
            const std::size_t next = cost + literal_count(prime) + 1;
            if (next <= bound()) {
                chosen.push_back(prime);
                branch(open & ~points_[choice.second], next, chosen);
                chosen.pop_back();
            }
        }
    }

    // What costs little more may be shorter once common literals are taken out.
    [[nodiscard]] std::size_t bound() const {
        constexpr std::size_t kMore = 2;
        return found_.empty() ? ~std::size_t{0} : cost_of(found_.front()) + kMore;
    }

    void keep(Cover cover) {
        remove_idle(on_, cover);
        std::sort(cover.begin(), cover.end());
        const auto at = std::upper_bound(
            found_.begin(),
            found_.end(),
            cover,
            [](const Cover& a, const Cover& b) {
                return std::pair(cost_of(a), a) < std::pair(cost_of(b), b);
            }
        );
        if (at != found_.begin() && *(at - 1) == cover) {
            return;
        }
        found_.insert(at, std::move(cover));
        if (found_.size() > kCoversMax) {
            found_.pop_back();
        }
    }

    const std::vector<std::uint32_t>& on_;
    std::vector<Cube> primes_;
    std::vector<Points> points_;                      // where each of them holds
    std::vector<std::vector<std::size_t>> of_point_;  // those that hold there
    std::vector<Cover> found_;                        // cheapest first
    std::size_t nodes_ = 0;
    std::size_t steps_;
};

// A prime implicant that holds at a point: the variables that most points off differ in, until
// each differs in one, and then without those that are not needed.
std::optional<Cube> short_implicant(
    const PartialFunction& function, std::uint32_t at, std::size_t& steps_left
) {
    std::uint32_t set = 0;
    std::vector<std::uint32_t> differences;
    for (const std::uint32_t point : function.off) {
        differences.push_back(point ^ at);
    }
    const std::vector<std::uint32_t> all = differences;
    while (!differences.empty()) {
        if (!take(steps_left, function.variables * differences.size())) {
            return std::nullopt;
        }
        std::uint32_t best = 0;
        std::ptrdiff_t best_count = 0;
        for (std::size_t variable = 0; variable < function.variables; ++variable) {
            const auto bit = std::uint32_t{1} << variable;
            const auto count =
                std::count_if(differences.begin(), differences.end(), [bit](std::uint32_t point) {
                    return (point & bit) != 0;
                });
            if (count > best_count) {
                best = bit;
                best_count = count;
            }
        }
        check(best != 0, "a point both on and off");
        set |= best;
        std::erase_if(differences, [best](std::uint32_t point) { return (point & best) != 0; });
    }
    if (!take(steps_left, function.variables * all.size())) {
        return std::nullopt;
    }
    for (std::uint32_t rest = set; rest != 0; rest &= rest - 1) {
        const std::uint32_t fewer = set & ~(rest & (~rest + 1));
        if (std::all_of(all.begin(), all.end(), [fewer](std::uint32_t point) {
                return (point & fewer) != 0;
            })) {
            set = fewer;
        }
    }
    return Cube{set, at & set};
}

std::vector<Cover> greedy_cover(const PartialFunction& function, std::size_t& steps_left) {
    Cover cover;
    std::vector<std::uint32_t> open = function.on;
    while (!open.empty()) {
        const auto cube = short_implicant(function, open.front(), steps_left);
        if (!cube) {
            return {};
        }
        cover.push_back(*cube);
        std::erase_if(open, [&cube](std::uint32_t point) { return cube->holds_at(point); });
    }
    if (!take(steps_left, cover.size() * function.on.size())) {
        return {};
    }
    remove_idle(function.on, cover);
    std::sort(cover.begin(), cover.end());
    return {cover};
}

}  // namespace

std::vector<Cover> find_covers(const PartialFunction& function, std::size_t& steps_left) {
    if (function.off.empty()) {
        return {{Cube{}}};
    }
    if (function.variables > kPrimesVariablesMax) {
        return greedy_cover(function, steps_left);
    }
    const std::size_t sets = std::size_t{1} << function.variables;
    if (!take(steps_left, sets * (function.variables * function.on.size() + function.off.size()))) {
        return {};
    }
    CoverSearch search(function);
    auto covers = search.run();
    return take(steps_left, search.steps()) ? std::move(covers) : std::vector<Cover>();
}

}  // namespace modelsynth::continuous
