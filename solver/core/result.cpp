#include "solver/core/result.h"

#include <stdexcept>

namespace modelsynth {

Error cancelled() { return {ErrorCode::kCancelled, "the synthesis was stopped"}; }

std::string pointer_part(std::string_view name) {
    std::string escaped;
    for (const char c : name) {
        if (c == '~') {
            escaped += "~0";
        } else if (c == '/') {
            escaped += "~1";
        } else {
            escaped += c;
        }
    }
    return escaped;
}

void check(bool condition, const char* why) {
    if (condition) {
        return;
    }
    throw std::logic_error(std::string("internal check failed: ") + why);
}

}  // namespace modelsynth
