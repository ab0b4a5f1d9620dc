#pragma once

#include "server/http/access_log.h"
#include "server/http/message.h"

namespace modelsynth::server {

// One request as it comes in, and what becomes of the connection after it.
struct Exchange {
    Request request;
    unsigned version = 11;
    bool keep_alive = true;
    bool chunked = false;
    AnswerRecord answer;
};

}  // namespace modelsynth::server
