#pragma once

#include "server/jobs/job_service.h"
#include "tests/unit/server/embedded_store.h"

#include <gtest/gtest.h>
#include <spdlog/sinks/null_sink.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

namespace modelsynth::server {

// For as long as it takes to look at a service.
inline constexpr const char* kLong =
    R"([60,10,60],"blocks":{"size":[20,10,20],"overlap":0.75,"passes":15})";

// The artifacts of another store on a disk of any size, that may be slow or have faults.
class ArtifactsOnADisk final : public ArtifactStore {
  public:
    explicit ArtifactsOnADisk(ArtifactStore& artifacts) : artifacts_(artifacts) {}

    [[nodiscard]] Space space() const override {
        return {artifacts_.space().used_bytes, free_bytes};
    }

    Stored<std::unique_ptr<Pin>> put(std::string_view bytes) override {
        if (is_broken) {
            throw std::logic_error("a fault of ours");
        }
        is_held.wait(true);
        return artifacts_.put(bytes);
    }

    Stored<std::unique_ptr<Pin>> pin(const std::string& digest) override {
        return artifacts_.pin(digest);
    }

    Stored<std::unique_ptr<Reader>> open(const std::string& digest) override {
        return artifacts_.open(digest);
    }

    Stored<std::string> load(const std::string& digest) override { return artifacts_.load(digest); }

    // What is put now is there once it is let go.
    void let_go() {
        is_held = false;
        is_held.notify_all();
    }

    std::atomic<std::uint64_t> free_bytes = 1'000'000;
    std::atomic<bool> is_broken = false;
    std::atomic<bool> is_held = false;

  private:
    ArtifactStore& artifacts_;
};

inline std::shared_ptr<spdlog::logger> no_log() {
    return std::make_shared<spdlog::logger>(
        "none", std::make_shared<spdlog::sinks::null_sink_mt>()
    );
}

// The id of the job, or the type of the problem.
inline std::string submit(JobService& service, const std::string& size) {
    auto submitted = service.submit(
        R"({"solver":"discrete","example":"castle","seed":7,"parameters":{"size":)" + size + "}}",
        "",
        {},
        ""
    );
    return submitted ? submitted->job.id : submitted.error().type;
}

// A service on a store of its own.
class ServiceSuite : public testing::Test {
  protected:
    std::unique_ptr<JobService> make_service(const JobServiceConfig& config) {
        return std::make_unique<JobService>(
            config,
            store_.jobs(),
            store_.events(),
            store_.examples(),
            artifacts_,
            no_log(),
            observer()
        );
    }

    virtual JobObserver& observer() { return nobody_; }

    EmbeddedStore store_;
    ArtifactsOnADisk artifacts_{store_.artifacts()};

  private:
    JobObserver nobody_;
};

}  // namespace modelsynth::server
