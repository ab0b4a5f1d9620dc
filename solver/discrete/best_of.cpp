#include "solver/discrete/best_of.h"

#include "solver/core/random.h"
#include "solver/discrete/objective.h"

#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>

namespace modelsynth::discrete {

namespace {

constexpr std::uint32_t kPurposeCandidate = 4;

class Contest {
  public:
    Contest(
        const Example& example,
        const Parameters& parameters,
        std::uint32_t candidates,
        std::uint64_t seed,
        const std::function<Result<std::vector<Label>>(std::uint64_t)>& make
    )
        : seed_(seed),
          make_(make),
          sums_(term_sums<BestOf>(example, parameters)),
          values_(candidates),
          errors_(candidates) {}

    // Makes what candidates there are left.
    void take_part() {
        try {
            for (std::uint32_t i = next_++; i < values_.size(); i = next_++) {
                auto model = make_(candidate_seed(seed_, i));
                if (model) {
                    values_[i] = weigh(*model);
                } else {
                    errors_[i] = std::move(model.error());
                }
                if (errors_[i] && errors_[i]->code == ErrorCode::kCancelled) {
                    next_ = static_cast<std::uint32_t>(values_.size());
                }
            }
        } catch (...) {
            const std::lock_guard lock(mutex_);
            fault_ = std::current_exception();
        }
    }

    // Once nobody takes part any more.
    Result<BestSeed> end() {
        if (fault_) {
            std::rethrow_exception(fault_);
        }
        std::optional<BestSeed> best;
        for (std::uint32_t i = 0; i < values_.size(); ++i) {
            if (errors_[i] && errors_[i]->code == ErrorCode::kCancelled) {
                return tl::unexpected(std::move(*errors_[i]));
            }
            if (values_[i] && (!best || *values_[i] < best->value)) {
                best = BestSeed{candidate_seed(seed_, i), *values_[i], {}};
            }
        }
        if (!best) {
            return tl::unexpected(std::move(*errors_.back()));
        }
        best->candidates = std::move(values_);
        return std::move(*best);
    }

  private:
    double weigh(const std::vector<Label>& model) const {
        double value = 0;
        for (TermSum sum : sums_) {
            sum.start(model);
            value += sum.value();
        }
        return value;
    }

    std::uint64_t seed_;
    const std::function<Result<std::vector<Label>>(std::uint64_t)>& make_;
    const std::vector<TermSum> sums_;
    std::atomic<std::uint32_t> next_ = 0;
    std::vector<std::optional<double>> values_;  // each is written by who makes the candidate
    std::vector<std::optional<Error>> errors_;
    std::mutex mutex_;
    std::exception_ptr fault_;
};

}  // namespace

std::uint64_t candidate_seed(std::uint64_t seed, std::uint32_t candidate) {
    return candidate == 0 ? seed : derive_seed({seed, candidate, 0, kPurposeCandidate});
}

Result<BestSeed> find_best_seed(
    const Example& example,
    const Parameters& parameters,
    std::uint32_t candidates,
    std::uint64_t seed,
    std::uint32_t threads,
    const std::function<Result<std::vector<Label>>(std::uint64_t)>& make
) {
    Contest contest(example, parameters, candidates, seed, make);
    {
        std::vector<std::jthread> helpers;
        for (std::uint32_t i = 1; i < std::min(threads, candidates); ++i) {
            try {
                helpers.emplace_back([&contest] { contest.take_part(); });
            } catch (const std::system_error&) {
                break;  // no more threads can be had
            }
        }
        contest.take_part();
    }
    return contest.end();
}

}  // namespace modelsynth::discrete
