#include "solver/registry/alternatives.h"

#include "solver/core/random.h"

#include <algorithm>
#include <utility>

namespace modelsynth {

namespace {

// Apart from every other use of the request's seed.
constexpr std::uint32_t kPurposeAlternative = 6;

}  // namespace

bool Alternatives::is_complete() const {
    return made() >= wanted_ || fruitless_ >= kFruitlessCandidatesMax;
}

std::uint64_t Alternatives::next_seed() const {
    return candidates_ == 0 ? seed_ : derive_seed({seed_, candidates_, 0, kPurposeAlternative});
}

std::optional<std::uint32_t> Alternatives::add(std::string model) {
    ++candidates_;
    const auto equal = std::find(models_.begin(), models_.end(), model);
    if (equal != models_.end()) {
        ++fruitless_;
        return static_cast<std::uint32_t>(equal - models_.begin());
    }
    fruitless_ = 0;
    models_.push_back(std::move(model));
    return std::nullopt;
}

bool Alternatives::add_failure(ErrorCode code) {
    ++candidates_;
    ++fruitless_;
    return code == ErrorCode::kGaveUp && fruitless_ < kFruitlessCandidatesMax;
}

}  // namespace modelsynth
