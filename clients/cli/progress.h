#pragma once

#include "clients/cli/job_event.h"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace modelsynth::cli {

// How far a synthesis has come.
struct Progress {
    std::uint64_t blocks_done = 0;
    std::uint64_t blocks_total = 0;
    std::uint64_t accepted = 0;
    std::uint64_t reverted = 0;
};

// The bar as one line of at most `width` columns, without a line end.
[[nodiscard]] std::string render_bar(
    const Progress& progress, std::chrono::seconds elapsed, std::size_t width
);

// "49 blocks (45 accepted, 4 reverted)"
[[nodiscard]] std::string describe_blocks(const Progress& progress);

// "1:07" or "1:00:07"
[[nodiscard]] std::string describe_time(std::chrono::seconds elapsed);

// How progress is shown on standard error.
enum class ProgressStyle : std::uint8_t {
    kNone,
    kLines,  // a line for each tenth of the blocks
    kBar,    // one line that is drawn over, for terminals
};

// A bar on a terminal, lines elsewhere; programs that read JSON get no lines.
[[nodiscard]] ProgressStyle choose_style(bool as_json);

// Shows the progress of one synthesis. Cheap to call for every block.
class ProgressDisplay {
  public:
    explicit ProgressDisplay(ProgressStyle style);
    // Leaves the cursor on a line of its own.
    ~ProgressDisplay();
    ProgressDisplay(const ProgressDisplay&) = delete;
    ProgressDisplay& operator=(const ProgressDisplay&) = delete;

    void take(const JobEvent& event);
    // Those that were told before, as by a job that begins anew, are not shown again.
    void warn(std::span<const std::string> warnings);
    void start(std::uint64_t blocks_total);
    void add_block(std::uint64_t blocks_done, std::uint64_t blocks_total, bool is_accepted);
    // Ends the bar, so that something else may be written.
    void finish();

    [[nodiscard]] const Progress& progress() const { return progress_; }

    [[nodiscard]] std::chrono::seconds elapsed() const;

  private:
    void note(const std::string& text);
    void show(bool is_due);
    void finish_line();

    using Clock = std::chrono::steady_clock;

    ProgressStyle style_;
    Progress progress_;
    Clock::time_point began_ = Clock::now();
    Clock::time_point drawn_;
    std::uint64_t tenths_shown_ = 0;
    bool is_drawn_ = false;
    bool has_warned_ = false;
};

}  // namespace modelsynth::cli
