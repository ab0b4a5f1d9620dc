#include "clients/cli/event_follower.h"

#include "clients/cli/interrupt.h"
#include "clients/cli/server_url.h"
#include "clients/cli/sse_parser.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <thread>
#include <utility>

namespace modelsynth::cli {

namespace {

using std::chrono::milliseconds;

// Connections in a row that bring no event: eight waits, 25 seconds in all.
constexpr int kFruitlessMax = 9;
constexpr milliseconds kFirstWait{200};
constexpr milliseconds kLongestWait{5000};
// A stream silent for so long may be dead without either side having been told.
constexpr std::chrono::seconds kSilenceMax{60};

void wait_for_retry(int fruitless) {
    const auto wait = std::min(kLongestWait, kFirstWait * (1 << std::min(fruitless - 1, 10)));
    const auto until = std::chrono::steady_clock::now() + wait;
    while (std::chrono::steady_clock::now() < until && !is_interrupted()) {
        std::this_thread::sleep_for(milliseconds(50));
    }
}

// Whether the same request may do better a little later.
bool is_passing(const Failure& failure) {
    return failure.code == ExitCode::kUnreachable || failure.status == 429 || failure.status >= 500;
}

class Follower {
  public:
    Follower(
        const HttpClient& client,
        const std::string& job_id,
        std::uint64_t after,
        const EventHandler& on_event
    )
        : client_(client),
          path_("/v1/jobs/" + percent_encode(job_id)),
          after_(after),
          seq_(after),
          on_event_(on_event) {}

    Outcome<JobEnd> run();

  private:
    // One connection: what it failed of, if it did.
    std::optional<Failure> read_stream();
    bool take(std::string_view bytes, SseParser& parser);
    bool take(const SseEvent& event);
    // The job's end where the stream, read to its end, tells of none: the reader asked for what
    // comes after the last event.
    Outcome<std::optional<JobEnd>> ask_job();

    const HttpClient& client_;
    const std::string path_;
    const std::uint64_t after_;
    std::uint64_t seq_;  // of the last event handed on
    const EventHandler& on_event_;
    std::optional<JobEnd> end_;
    std::string misfit_;  // what was wrong with the last event, where something was
};

Outcome<JobEnd> Follower::run() {
    int fruitless = 0;
    std::optional<JobEnd> asked;
    while (true) {
        const std::uint64_t before = seq_;
        const std::optional<Failure> failure = read_stream();
        if (end_) {
            return *end_;
        }
        if (is_interrupted()) {
            return tl::unexpected(Failure{ExitCode::kInterrupted, "interrupted"});
        }
        const bool is_fruitful = seq_ > before || (failure && failure->is_idle);
        fruitless = is_fruitful ? 0 : fruitless + 1;
        if (failure && (!is_passing(*failure) || fruitless >= kFruitlessMax)) {
            return tl::unexpected(*failure);
        }
        if (!failure && fruitless > 0) {
            if (asked) {
                return *asked;  // known to have ended before the last connection found nothing
            }
            auto answer = ask_job();
            if (!answer && !is_passing(answer.error())) {
                return tl::unexpected(std::move(answer.error()));
            }
            asked = answer ? *answer : std::nullopt;
            if (!asked && fruitless >= kFruitlessMax) {
                return tl::unexpected(Failure{
                    ExitCode::kUnreachable, "the server keeps ending the events early"});
            }
        }
        if (fruitless > 0) {
            wait_for_retry(fruitless);
        }
    }
}

std::optional<Failure> Follower::read_stream() {
    HttpRequest request;
    request.target = path_ + "/events?after=" + std::to_string(seq_);
    request.headers = {{"Accept", "text/event-stream"}, {"Cache-Control", "no-cache"}};
    if (seq_ > after_) {
        request.headers.emplace_back("Last-Event-ID", std::to_string(seq_));
    }
    request.idle_max = kSilenceMax;
    SseParser parser;
    misfit_.clear();
    const auto answer = client_.send(request, [this, &parser](std::string_view bytes) {
        return take(bytes, parser) && !is_interrupted();
    });
    if (!misfit_.empty()) {
        return Failure{ExitCode::kUnreachable, misfit_};
    }
    return answer ? std::nullopt : std::optional(answer.error());
}

bool Follower::take(std::string_view bytes, SseParser& parser) {
    const auto events = parser.feed(bytes);
    if (!events) {
        misfit_ = "the server sent an event without an end";
        return false;
    }
    return std::all_of(events->begin(), events->end(), [this](const SseEvent& event) {
        return take(event);
    });
}

bool Follower::take(const SseEvent& event) {
    const auto job_event = parse_job_event(event.data);
    if (!job_event) {
        misfit_ = "the server sent an event that cannot be read";
        return false;
    }
    if (job_event->seq <= seq_) {
        return true;  // sent again
    }
    if (job_event->seq != seq_ + 1 && job_event->type != "snapshot") {
        misfit_ = "the server left out an event";
        return false;
    }
    seq_ = job_event->seq;
    on_event_(*job_event);
    end_ = end_of_event(*job_event);
    return !end_;
}

Outcome<std::optional<JobEnd>> Follower::ask_job() {
    return client_.send({.target = path_}).map([](const HttpAnswer& answer) {
        return end_of_job(answer.body);
    });
}

}  // namespace

Outcome<JobEnd> follow_job(
    const HttpClient& client,
    const std::string& job_id,
    std::uint64_t after,
    const EventHandler& on_event
) {
    return Follower(client, job_id, after, on_event).run();
}

}  // namespace modelsynth::cli
