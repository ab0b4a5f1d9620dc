#include "server/ops/config.h"

#include "server/ops/config_file.h"
#include "tests/unit/server/embedded_store.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <random>

namespace modelsynth::server {
namespace {

// A variable as long as this lives.
class Variable {
  public:
    Variable(std::string name, const std::string& value) : name_(std::move(name)) {
        ::setenv(name_.c_str(), value.c_str(), 1);
    }

    Variable(const Variable&) = delete;
    Variable& operator=(const Variable&) = delete;

    ~Variable() { ::unsetenv(name_.c_str()); }

  private:
    std::string name_;
};

class Configuration : public testing::Test {
  protected:
    // What parse_arguments() makes of them, and what it prints.
    struct Parsed {
        tl::expected<Config, int> config;
        std::string out;
        std::string err;
    };

    static Parsed parse(std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), "modelsynthd");
        std::vector<const char*> argv;
        for (const std::string& argument : arguments) {
            argv.push_back(argument.c_str());
        }
        testing::internal::CaptureStdout();
        testing::internal::CaptureStderr();
        auto config = parse_arguments(static_cast<int>(argv.size()), argv.data());
        std::string out = testing::internal::GetCapturedStdout();
        return {std::move(config), std::move(out), testing::internal::GetCapturedStderr()};
    }

    std::string write(const std::string& text, const std::string& name = "server.conf") {
        const std::string path = (directory_.path() / name).string();
        std::ofstream(path, std::ios::binary) << text;
        return path;
    }

    TemporaryDirectory directory_;
};

TEST_F(Configuration, TheCommandLineGoesBeforeTheEnvironmentAndThatBeforeTheFile) {
    const std::string file = write("queue-max = 3\nworkers = 3\nidle-seconds = 3\n");
    const Variable queue("MODELSYNTH_QUEUE_MAX", "2");
    const Variable workers("MODELSYNTH_WORKERS", "2");
    const Variable config_file("MODELSYNTH_CONFIG", file);
    const auto parsed = parse({"--queue-max", "1"});
    ASSERT_TRUE(parsed.config) << parsed.err;
    EXPECT_EQ(parsed.config->jobs.queue_max, 1U);
    EXPECT_EQ(parsed.config->jobs.workers, 2U);
    EXPECT_EQ(parsed.config->http.limits.idle_seconds, 3U);
    EXPECT_EQ(parsed.config->http.limits.head_seconds, HttpLimits{}.head_seconds);
}

TEST_F(Configuration, AsManyWebhooksWaitAsAnyOfTheThreeSays) {
    EXPECT_EQ(parse({}).config->jobs.webhooks_waiting_max, 1000U);
    const std::string file = write("webhooks-waiting-max = 3\n");
    EXPECT_EQ(parse({"--config", file}).config->jobs.webhooks_waiting_max, 3U);
    const Variable waiting("MODELSYNTH_WEBHOOKS_WAITING_MAX", "2");
    EXPECT_EQ(parse({"--config", file}).config->jobs.webhooks_waiting_max, 2U);
    const auto parsed = parse({"--config", file, "--webhooks-waiting-max", "1"});
    EXPECT_EQ(parsed.config->jobs.webhooks_waiting_max, 1U);
    for (const char* wrong : {"0", "-1", "1000001", "x", ""}) {
        EXPECT_FALSE(parse({"--webhooks-waiting-max", wrong}).config) << wrong;
    }
}

TEST_F(Configuration, ListsComeFromAllThree) {
    const auto origins = [](const Parsed& parsed) {
        return parsed.config.value().access.browsers.origins;
    };
    const std::vector<std::string> both = {"http://a.example", "http://b.example"};
    EXPECT_EQ(origins(parse({"--allow-origin", both[0], "--allow-origin", both[1]})), both);
    for (const char* text :
         {"allow-origin = [\"http://a.example\", http://b.example]  # both",
          "allow-origin = http://a.example\nallow-origin = 'http://b.example'"}) {
        EXPECT_EQ(origins(parse({"--config", write(text)})), both);
    }
    const Variable variable("MODELSYNTH_ALLOW_ORIGIN", both[0] + "," + both[1]);
    EXPECT_EQ(origins(parse({})), both);
}

TEST_F(Configuration, EveryFaultIsToldWithItsPlace) {
    const std::string file = write(
        "# fine\nqueue-max = 0\nunknown = 1\n[section]\nworkers\nworkers = 1 2\n"
        "idle-seconds =\nhead-seconds = \"1\nlog-level = loud\nlisten = nowhere:1\nconfig = x\n"
        "fields-max = 10\nfields-max = 11\n"
    );
    const Variable variable("MODELSYNTH_BODY_SECONDS", "-1");
    const auto parsed = parse({"--config", file, "--check-config"});
    ASSERT_FALSE(parsed.config);
    EXPECT_EQ(parsed.config.error(), 2);
    for (const char* place :
         {":2: ", ":3: ", ":4: ", ":5: ", ":6: ", ":7: ", ":8: ", ":9: ", ":11: ", ":13: "}) {
        EXPECT_NE(parsed.err.find(file + place), std::string::npos) << place << parsed.err;
    }
    EXPECT_NE(parsed.err.find("MODELSYNTH_BODY_SECONDS: "), std::string::npos) << parsed.err;
    EXPECT_NE(parsed.err.find("--listen: "), std::string::npos) << parsed.err;
    EXPECT_EQ(parsed.err.find(file + ":1: "), std::string::npos) << parsed.err;
}

TEST_F(Configuration, IsCheckedWithoutBeingUsed) {
    const auto fine = parse({"--check-config", "--data", "/nonexistent/store"});
    EXPECT_EQ(fine.config.error(), 0);
    EXPECT_EQ(fine.err, "");
    const std::string keys = write(R"({"keys": [{"name": "a"}]})", "keys.json");
    const auto bad_keys = parse({"--check-config", "--keys", keys});
    EXPECT_EQ(bad_keys.config.error(), 2);
    EXPECT_NE(bad_keys.err.find("/keys/0"), std::string::npos) << bad_keys.err;
    EXPECT_EQ(parse({"--config", "/nonexistent"}).config.error(), 2);
    EXPECT_EQ(parse({"--config", directory_.path().string()}).config.error(), 2);
    EXPECT_EQ(parse({"--nonsense"}).config.error(), 2);
    EXPECT_EQ(parse({"--help"}).config.error(), 0);
    EXPECT_EQ(parse({"--version"}).config.error(), 0);
}

TEST_F(Configuration, WhatIsPrintedReadsTheSameAgain) {
    const auto printed = parse(
        {"--print-config",
         "--data",
         "a \"quoted\" \\ place # here",
         "--queue-max",
         "17",
         "--allow-host",
         "a.example",
         "--allow-host",
         "b.example",
         "--retention-hours",
         "0.5"}
    );
    ASSERT_EQ(printed.config.error(), 0) << printed.err;
    const std::string file = write(printed.out);
    EXPECT_EQ(parse({"--print-config", "--config", file}).out, printed.out);
    const auto again = parse({"--config", file});
    ASSERT_TRUE(again.config) << again.err;
    EXPECT_EQ(again.config->data_directory, "a \"quoted\" \\ place # here");
    EXPECT_EQ(again.config->jobs.queue_max, 17U);
    EXPECT_EQ(again.config->access.browsers.hosts.size(), 2U);
    EXPECT_EQ(again.config->retention_ms, 1'800'000);
    EXPECT_EQ(again.config->jobs.forget_after_expiry_ms, 3 * 1'800'000);
    EXPECT_EQ(again.config->http.limits.connections_per_address_max, 0U);
}

TEST_F(Configuration, NumbersAreTakenUpToTheirEdges) {
    struct Edge {
        const char* option;
        const char* least;
        const char* most;
        const char* too_little;
        const char* too_much;
    };

    for (const Edge& edge : std::vector<Edge>{
             {"--workers", "1", "256", "0", "257"},
             {"--json-depth-max", "8", "256", "7", "257"},
             {"--fields-max", "8", "10000", "7", "10001"},
             {"--retention-hours", "0.001", "87600", "0.0009", "87601"},
             {"--drain-timeout", "0", "86400", "-1", "86401"},
             {"--connections-per-address-max", "0", "1000000", "-1", "1000001"},
             {"--webhook-first-delay", "0.001", "3600", "0.0009", "3601"},
             {"--webhook-seconds", "1", "300", "0", "301"},
             {"--data-bytes-max", "0", "1125899906842624", "-1", "1125899906842625"}}) {
        for (const char* good : {edge.least, edge.most}) {
            EXPECT_TRUE(parse({edge.option, good, "--forget-hours", "87600"}).config)
                << edge.option << good;
        }
        for (const char* bad :
             {edge.too_little,
              edge.too_much,
              "nan",
              "inf",
              "1x",
              "",
              "0x10",
              "99999999999999999999999"}) {
            EXPECT_FALSE(parse({edge.option, bad}).config) << edge.option << ' ' << bad;
        }
    }
}

TEST_F(Configuration, NumbersAreDecimal) {
    EXPECT_FALSE(parse({"--workers", "010"}).config);
    EXPECT_FALSE(parse({"--workers", "+1"}).config);
    EXPECT_FALSE(parse({"--webhook-seconds", "010"}).config);
    EXPECT_EQ(parse({"--workers", "10"}).config->jobs.workers, 10U);
}

TEST_F(Configuration, AnAddressThatOthersReachNeedsKeysAndLimitsEachPeer) {
    EXPECT_FALSE(parse({"--listen", "0.0.0.0:1"}).config);
    const auto open = parse({"--listen", "[::]:1", "--keys", "keys.json"});
    ASSERT_TRUE(open.config) << open.err;
    EXPECT_EQ(open.config->http.address, "::");
    EXPECT_EQ(open.config->http.limits.connections_per_address_max, 64U);
}

// Whatever the bytes are, they are read or refused.
TEST_F(Configuration, AnyFileIsReadOrRefused) {
    static const std::vector<std::string> kParts = {
        "queue-max",
        "allow-origin",
        " = ",
        "=",
        "\n",
        "\"",
        "'",
        "[",
        "]",
        ",",
        "#",
        ";",
        "\\",
        "1",
        "x",
        " ",
        "\r",
        "\t",
        std::string(1, '\0'),
        "\xff",
        "[[a]]",
        "-",
        "--help",
        "config"};
    std::mt19937 random(11);
    for (int i = 0; i < 20'000; ++i) {
        std::string text;
        for (std::size_t n = random() % 24; n > 0; --n) {
            text += kParts[random() % kParts.size()];
        }
        std::vector<ConfigFault> faults;
        for (const ConfigLine& line : parse_config_file(text, "file", faults)) {
            ASSERT_GT(line.number, 0U);
            ASSERT_FALSE(line.values.empty() && text.find('[') == std::string::npos) << text;
        }
    }
    for (int i = 0; i < 100; ++i) {
        std::string text(random() % 200, '\0');
        for (char& c : text) {
            c = static_cast<char>(random());
        }
        const auto parsed = parse({"--config", write(text)});
        ASSERT_TRUE(parsed.config || parsed.config.error() == 2);
    }
}

}  // namespace
}  // namespace modelsynth::server
