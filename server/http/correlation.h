#pragma once

#include "server/http/message.h"

#include <string>

// What ties a request to what else is known of it, here and elsewhere.

namespace modelsynth::server {

// A new id of a request: 16 hexadecimal digits. Thread-safe.
[[nodiscard]] std::string make_request_id();

// Takes what the header fields of the request tell: its own id (X-Request-Id) when it has 1 to 64
// of A-Z a-z 0-9 . _ -, and the trace that it belongs to (traceparent, W3C Trace Context) when
// there is one and well-formed. Anything else is left as it is.
void take_correlation(Request& request);

}  // namespace modelsynth::server
