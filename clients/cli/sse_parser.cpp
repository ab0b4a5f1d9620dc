#include "clients/cli/sse_parser.h"

#include <utility>

namespace modelsynth::cli {

std::optional<std::vector<SseEvent>> SseParser::feed(std::string_view bytes) {
    std::vector<SseEvent> events;
    while (!bytes.empty() && !is_too_long_) {
        if (std::exchange(has_carriage_return_, false) && bytes.front() == '\n') {
            bytes.remove_prefix(1);
            continue;
        }
        const std::size_t end = bytes.find_first_of("\r\n");
        line_ += bytes.substr(0, end);
        is_too_long_ = line_.size() + data_.size() > event_bytes_max_;
        if (end == std::string_view::npos) {
            break;
        }
        has_carriage_return_ = bytes[end] == '\r';
        bytes.remove_prefix(end + 1);
        end_line(events);
    }
    if (is_too_long_) {
        return std::nullopt;
    }
    return events;
}

void SseParser::end_line(std::vector<SseEvent>& events) {
    std::string_view line = line_;
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    if (std::exchange(is_first_line_, false) && line.starts_with(kByteOrderMark)) {
        line.remove_prefix(kByteOrderMark.size());
    }
    if (line.empty()) {
        dispatch(events);
    } else if (const std::size_t colon = line.find(':'); colon != 0) {
        std::string_view value =
            colon == std::string_view::npos ? std::string_view() : line.substr(colon + 1);
        if (value.starts_with(' ')) {
            value.remove_prefix(1);
        }
        take_field(line.substr(0, colon), value);
    }
    line_.clear();
}

void SseParser::take_field(std::string_view name, std::string_view value) {
    if (name == "data") {
        data_ += value;
        data_ += '\n';
    } else if (name == "event") {
        type_ = value;
    } else if (name == "id" && value.find('\0') == std::string_view::npos) {
        last_event_id_ = value;
    }
}

void SseParser::dispatch(std::vector<SseEvent>& events) {
    if (!data_.empty()) {
        data_.pop_back();
        events.push_back(
            {type_.empty() ? "message" : std::move(type_), std::move(data_), last_event_id_}
        );
    }
    type_.clear();
    data_.clear();
}

}  // namespace modelsynth::cli
