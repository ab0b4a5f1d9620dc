#include "clients/cli/progress.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace modelsynth::cli {

namespace {

constexpr std::chrono::milliseconds kRedrawPeriod{100};
constexpr std::size_t kUsualWidth = 80;
constexpr std::size_t kBarWidthMin = 8;
constexpr std::size_t kBarWidthMax = 60;

std::size_t terminal_width() {
    winsize size = {};
    const bool is_known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
    return is_known ? size.ws_col : kUsualWidth;
}

double share_done(const Progress& progress) {
    if (progress.blocks_total == 0) {
        return 0;
    }
    const double share =
        static_cast<double>(progress.blocks_done) / static_cast<double>(progress.blocks_total);
    return std::min(share, 1.0);
}

std::string two_digits(std::int64_t number) {
    return (number < 10 ? "0" : "") + std::to_string(number);
}

std::string percent(const Progress& progress) {
    const std::string number = std::to_string(static_cast<int>(share_done(progress) * 100));
    return std::string(3 - std::min<std::size_t>(3, number.size()), ' ') + number + "%";
}

}  // namespace

std::string render_bar(const Progress& progress, std::chrono::seconds elapsed, std::size_t width) {
    const std::string counts =
        percent(progress) + "  " + std::to_string(progress.blocks_done) + "/" +
        std::to_string(progress.blocks_total) + " blocks  " + std::to_string(progress.accepted) +
        " accepted  " + std::to_string(progress.reverted) + " reverted  " + describe_time(elapsed);
    constexpr std::size_t kFrame = 3;  // the brackets and a space
    if (width < counts.size() + kFrame + kBarWidthMin) {
        return counts.substr(0, width);
    }
    const std::size_t bar = std::min(width - counts.size() - kFrame, kBarWidthMax);
    const auto filled = static_cast<std::size_t>(share_done(progress) * static_cast<double>(bar));
    return "[" + std::string(filled, '#') + std::string(bar - filled, '.') + "] " + counts;
}

std::string describe_blocks(const Progress& progress) {
    return std::to_string(progress.blocks_done) +
           (progress.blocks_done == 1 ? " block (" : " blocks (") +
           std::to_string(progress.accepted) + " accepted, " + std::to_string(progress.reverted) +
           " reverted)";
}

std::string describe_time(std::chrono::seconds elapsed) {
    const auto count = elapsed.count();
    const std::string seconds = ":" + two_digits(count % 60);
    return count < 3600
               ? std::to_string(count / 60) + seconds
               : std::to_string(count / 3600) + ":" + two_digits(count / 60 % 60) + seconds;
}

ProgressStyle choose_style(bool as_json) {
    if (isatty(STDERR_FILENO) == 1) {
        return ProgressStyle::kBar;
    }
    return as_json ? ProgressStyle::kNone : ProgressStyle::kLines;
}

ProgressDisplay::ProgressDisplay(ProgressStyle style) : style_(style) {}

ProgressDisplay::~ProgressDisplay() { finish(); }

void ProgressDisplay::take(const JobEvent& event) {
    if (event.type == "queued") {
        note("queued, " + std::to_string(event.position) + " before it");
    } else if (event.type == "started") {
        warn(event.warnings);
        start(event.blocks_total);
    } else if (event.type == "block") {
        add_block(event.blocks_done, event.blocks_total, event.is_accepted);
    } else if (event.type == "snapshot") {
        progress_.blocks_done = event.blocks_done;
        progress_.blocks_total = event.blocks_total;
        show(true);
    } else if (event.type == "succeeded") {
        // Counted anew: a reader that began late or lost events has not seen every block.
        progress_.accepted = event.accepted;
        progress_.reverted = event.reverted;
        progress_.blocks_done = event.accepted + event.reverted;
        progress_.blocks_total = progress_.blocks_done;
    }
}

void ProgressDisplay::warn(std::span<const std::string> warnings) {
    if (style_ == ProgressStyle::kNone || has_warned_) {
        return;
    }
    for (const std::string& warning : warnings) {
        note("warning: " + warning);
        finish_line();
        has_warned_ = true;
    }
}

void ProgressDisplay::start(std::uint64_t blocks_total) {
    progress_ = {};
    progress_.blocks_total = blocks_total;
    tenths_shown_ = 0;
    note("started, " + std::to_string(blocks_total) + " blocks");
    show(true);
}

void ProgressDisplay::add_block(
    std::uint64_t blocks_done, std::uint64_t blocks_total, bool is_accepted
) {
    progress_.blocks_done = blocks_done;
    progress_.blocks_total = blocks_total;
    ++(is_accepted ? progress_.accepted : progress_.reverted);
    show(blocks_done == blocks_total);
}

void ProgressDisplay::finish() {
    if (is_drawn_) {
        show(true);
        finish_line();
    }
}

std::chrono::seconds ProgressDisplay::elapsed() const {
    return std::chrono::duration_cast<std::chrono::seconds>(Clock::now() - began_);
}

void ProgressDisplay::finish_line() {
    if (is_drawn_) {
        std::fputc('\n', stderr);
        is_drawn_ = false;
    }
}

void ProgressDisplay::note(const std::string& text) {
    if (style_ == ProgressStyle::kBar) {
        std::fprintf(stderr, "\r\x1b[K%s", text.c_str());
        is_drawn_ = true;
    } else if (style_ == ProgressStyle::kLines) {
        std::fprintf(stderr, "%s\n", text.c_str());
    }
}

void ProgressDisplay::show(bool is_due) {
    const auto now = Clock::now();
    if (style_ == ProgressStyle::kBar && (is_due || now - drawn_ >= kRedrawPeriod)) {
        drawn_ = now;
        // One column stays free: some terminals wrap when the last one is written.
        note(render_bar(progress_, elapsed(), terminal_width() - 1));
    }
    const auto tenths = static_cast<std::uint64_t>(share_done(progress_) * 10);
    if (style_ == ProgressStyle::kLines && tenths > tenths_shown_) {
        tenths_shown_ = tenths;
        note(
            percent(progress_) + "  " + describe_blocks(progress_) + "  " + describe_time(elapsed())
        );
    }
}

}  // namespace modelsynth::cli
