#include "server/ops/number_checks.h"

#include <sstream>

namespace modelsynth::server {

OptionCheck check_whole_number(std::uint64_t least, std::uint64_t most) {
    return [least, most](const std::string& text) -> std::string {
        const bool is_number = !text.empty() && text.size() < 20 &&
                               text.find_first_not_of("0123456789") == std::string::npos &&
                               (text.size() == 1 || text.front() != '0');
        const bool is_within = is_number && std::stoull(text) >= least && std::stoull(text) <= most;
        return is_within ? ""
                         : "must be a whole number from " + std::to_string(least) + " to " +
                               std::to_string(most);
    };
}

OptionCheck check_number(double least, double most) {
    return [least, most](const std::string& text) -> std::string {
        std::istringstream stream(text);
        double number = 0;
        // Written so that what is no number fails as well.
        const bool is_within =
            stream >> number && stream.eof() && number >= least && number <= most;
        std::ostringstream why;
        why << "must be a number from " << least << " to " << most;
        return is_within ? "" : why.str();
    };
}

}  // namespace modelsynth::server
