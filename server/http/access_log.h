#pragma once

#include "server/http/message.h"

#include <chrono>
#include <cstdint>
#include <string>

namespace modelsynth::server {

struct ConnectionContext;

// What became of a request, as it goes out.
struct AnswerRecord {
    std::chrono::steady_clock::time_point begun = {};  // when its first byte was there
    int status = 0;                                    // 0: nothing was sent
    std::uint64_t bytes = 0;
    bool is_stream = false;
    std::string job_id = {};   // that was made by it
    std::string problem = {};  // see Response
};

// Counts the request and logs it, once it is answered: at debug what merely looks, for health and
// metrics, all else at info. Of the query and of keys nothing is told but the key's name.
void report_answer(
    const Request& request, const AnswerRecord& answer, const ConnectionContext& context
);

}  // namespace modelsynth::server
