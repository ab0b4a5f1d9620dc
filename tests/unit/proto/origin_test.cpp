// `from` of a job request: what is taken from the finished job, what is told of it, what is wrong.

#include "proto/job_request.h"
#include "solver/examples/built_in.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace modelsynth::proto {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kLine = R"({"kind": "discrete", "name": "line",
    "pieces": [{"name": "empty"}, {"name": "ground"}, {"name": "wall"}], "size": [4, 2, 3],
    "cells": [1,1,1,1, 1,1,1,1, 1,1,1,1, 0,2,0,0, 0,2,0,0, 0,0,0,0], "empty": "empty"})";

// Jobs that have finished, by id, and the others by the name of the problem they are answered with.
class Origin : public testing::Test {
  protected:
    static std::optional<Example> find_built_in(const std::string& id) {
        for (const auto& example : examples::built_in()) {
            if (example->name == id) {
                return example;
            }
        }
        return std::nullopt;
    }

    Parsed<JobRequest> parse(const std::string& body, const RequestLimits& limits = {}) {
        return parse_job_request(
            body,
            limits,
            find_built_in,
            [this](const std::string& id, std::uint32_t alternative) -> Parsed<JobRequest> {
                alternative_ = alternative;
                if (const auto job = jobs_.find(id); job != jobs_.end()) {
                    return job->second;
                }
                const auto problem = problems_.find(id);
                return tl::unexpected(
                    problem == problems_.end()
                        ? make_problem("not-found", "there is no such job")
                        : make_problem(problem->second, "it is not to be had")
                );
            },
            11
        );
    }

    // Throws when it is refused.
    JobRequest accept(const std::string& body) {
        auto request = parse(body);
        if (!request) {
            throw std::runtime_error(to_json(request.error()));
        }
        return std::move(*request);
    }

    Json echo_of(const std::string& body) { return Json::parse(accept(body).echo); }

    // A request with these further fields that starts from the job.
    Json echo_from(const std::string& id, const std::string& from, const std::string& fields) {
        return echo_of(R"({"from": {"job": ")" + id + "\"" + from + "}" + fields + "}");
    }

    void finish(const std::string& id, const std::string& body) { jobs_[id] = accept(body); }

    std::vector<std::string> pointers_of(const std::string& body) {
        const auto request = parse(body);
        std::vector<std::string> found;
        if (!request) {
            EXPECT_EQ(request.error().status, 422) << to_json(request.error());
            for (const Fault& fault : request.error().errors) {
                found.push_back(fault.pointer);
            }
        }
        return found;
    }

    std::map<std::string, JobRequest> jobs_;
    std::map<std::string, std::string> problems_;
    std::optional<std::uint32_t> alternative_;  // that was asked for last
};

using Pointers = std::vector<std::string>;

TEST_F(Origin, WhatIsNotGivenIsTheEarlierJobs) {
    finish("a", R"({"solver": "discrete", "example": "city", "seed": 3, "priority": 4,
        "deadline": 9, "tags": {"a": "b"}, "parameters": {"size": [20, 10, 21], "order": "random",
        "weights": {"air": 2.5}, "boundary": {"top": "air", "north": "free"},
        "blocks": {"overlap": 0.25},
        "constraints": [{"kind": "fixed", "pieces": ["air"], "cells": [[1, 9, 1]]}]}})");
    const Json earlier = Json::parse(jobs_["a"].echo);
    const Json echo = echo_from("a", "", "");
    EXPECT_EQ(echo["solver"], "discrete");
    EXPECT_EQ(echo["example"], "city");
    EXPECT_EQ(echo["parameters"], earlier["parameters"]);
    // These belong to the one job.
    EXPECT_EQ(echo["seed"], 11);
    EXPECT_EQ(echo["priority"], 0);
    EXPECT_FALSE(echo.contains("deadline"));
    EXPECT_EQ(echo["tags"], Json::object());
}

TEST_F(Origin, EachFieldOfTheParametersIsTakenForItself) {
    finish("a", R"({"solver": "discrete", "example": "city", "parameters": {"size": [20, 10, 21],
        "order": "random", "weights": {"air": 2.5}, "boundary": {"top": "air", "north": "free"},
        "blocks": {"overlap": 0.25},
        "constraints": [{"kind": "fixed", "pieces": ["air"], "cells": [[1, 9, 1]]}]}})");
    Json expected = Json::parse(jobs_["a"].echo)["parameters"];
    expected["constraints"] = Json::array();
    expected["boundary"]["north"] = "periodic";
    expected["boundary"]["south"] = "periodic";
    expected["weights"] = "uniform";
    EXPECT_EQ(
        echo_from("a", "", R"(, "parameters": {"constraints": [], "weights": "uniform",
            "boundary": {"north": "periodic", "south": "periodic"}})")["parameters"],
        expected
    );
}

TEST_F(Origin, TheEchoTellsWhereItStandsAndWhatIsMadeAnew) {
    finish(
        "a", R"({"solver": "discrete", "example": "castle", "parameters": {"size": [9, 8, 7]}})"
    );
    const Json echo = echo_from(
        "a",
        R"(, "at": [1, 0, 2], "box": {"min": [0, 0, 0], "max": [2, 8, 2]}, "cells": [[3, 3, 3]],
            "voxels": {"size": [1, 1, 1], "values": [0.25]})",
        R"(, "parameters": {"size": [12, 8, 12]})"
    );
    EXPECT_EQ(echo["from"], Json::parse(R"({"job": "a", "size": [9, 8, 7], "at": [1, 0, 2],
            "box": {"min": [0, 0, 0], "max": [2, 8, 2]}, "cells": [[3, 3, 3]],
            "voxels": {"size": [1, 1, 1], "values": [0.25]}})"));
    const JobRequest request = accept(echo.dump());
    EXPECT_EQ(request.echo, echo.dump());
    ASSERT_TRUE(request.from);
    EXPECT_EQ(request.from->job_id, "a");
    EXPECT_EQ(std::get<discrete::Origin>(request.from->origin).size, (GridSize{9, 8, 7}));
    EXPECT_EQ(std::get<discrete::Origin>(request.from->origin).at, (Cell{1, 0, 2}));
    EXPECT_EQ(
        std::get<discrete::Origin>(request.from->origin).remade.box, (Box{{0, 0, 0}, {2, 8, 2}})
    );
    EXPECT_EQ(
        std::get<discrete::Origin>(request.from->origin).remade.cells,
        (std::vector<Cell>{{3, 3, 3}})
    );
}

TEST_F(Origin, TheAlternativeIsAskedForAndStandsInTheEcho) {
    jobs_["one"] = accept(
        R"({"solver": "discrete", "example": "castle", "seed": 5, "alternatives": 4,
            "parameters": {"size": [20, 8, 20]}})"
    );
    const JobRequest third = accept(R"({"from": {"job": "one", "alternative": 2}})");
    EXPECT_EQ(alternative_, 2U);
    EXPECT_EQ(third.from->alternative, 2U);
    EXPECT_NE(third.echo.find(R"("alternative":2)"), std::string::npos) << third.echo;
    EXPECT_FALSE(third.alternatives);
    const JobRequest first = accept(R"({"from": {"job": "one"}, "alternatives": 2})");
    EXPECT_EQ(alternative_, 0U);
    EXPECT_EQ(first.echo.find(R"("alternative":)"), std::string::npos) << first.echo;
    EXPECT_EQ(first.alternatives, 2U);
}

TEST_F(Origin, AnAlternativeThatIsNotThereIsAFaultOfTheRequest) {
    const auto request = parse(R"({"from": {"job": "none", "alternative": 63}})");
    ASSERT_FALSE(request);
    EXPECT_EQ(request.error().errors.front().pointer, "/from/alternative");
    for (const char* bad : {"64", "-1", "1.5", "null", "\"1\""}) {
        const auto refused =
            parse(R"({"from": {"job": "none", "alternative": )" + std::string(bad) + "}}");
        ASSERT_FALSE(refused);
        EXPECT_EQ(refused.error().errors.front().pointer, "/from/alternative") << bad;
    }
}

TEST_F(Origin, AnEchoIsReadWithoutTheEarlierJob) {
    finish(
        "a",
        std::string(R"({"solver": "discrete", "parameters": {"size": [9, 2, 7]},
        "example": )") +
            kLine + "}"
    );
    const std::string echo = echo_from("a", R"(, "cells": [[0, 0, 0]])", "").dump();
    const auto again = parse_job_request(echo, {}, find_built_in, nullptr, 0);
    ASSERT_TRUE(again) << to_json(again.error());
    EXPECT_EQ(again->echo, echo);
    EXPECT_EQ(std::get<discrete::Origin>(again->from->origin).size, (GridSize{9, 2, 7}));
    // Nobody can be asked for what it does not tell.
    for (const char* field : {"solver", "example"}) {
        Json lacking = Json::parse(echo);
        lacking.erase(field);
        EXPECT_FALSE(parse_job_request(lacking.dump(), {}, find_built_in, nullptr, 0)) << field;
    }
    Json lacking = Json::parse(echo);
    lacking["from"].erase("size");
    EXPECT_FALSE(parse_job_request(lacking.dump(), {}, find_built_in, nullptr, 0));
}

TEST_F(Origin, AnExampleThatCameWithTheJobGoesOn) {
    finish("a", std::string(R"({"solver": "discrete", "example": )") + kLine + "}");
    const Json echo = echo_from("a", "", "");
    EXPECT_EQ(echo["example"], Json::parse(jobs_["a"].echo)["example"]);
    jobs_["b"] = accept(echo.dump());
    EXPECT_EQ(echo_from("b", "", "")["example"], echo["example"]);
}

TEST_F(Origin, AnExampleThatIsNoLongerThereIsTheJobs) {
    finish("a", std::string(R"({"solver": "discrete", "example": )") + kLine + "}");
    jobs_["a"].example_id = "uploaded";
    Json echo = Json::parse(jobs_["a"].echo);
    echo["example"] = "uploaded";
    jobs_["a"].echo = echo.dump();
    EXPECT_EQ(echo_from("a", "", "")["example"], "uploaded");
    EXPECT_EQ(echo_from("a", "", R"(, "example": "uploaded")")["example"], "uploaded");
    EXPECT_EQ(pointers_of(R"({"from": {"job": "a"}, "example": "other"})"), Pointers{"/example"});
}

TEST_F(Origin, AnotherExampleNeedsTheSamePieces) {
    finish("a", std::string(R"({"solver": "discrete", "example": )") + kLine + "}");
    Json other = Json::parse(kLine);
    other["name"] = "other";
    other["adjacency"] = Json::parse(R"({"x": [["wall", "wall"]]})");
    const auto with = [](const Json& example) {
        return R"({"from": {"job": "a"}, "example": )" + example.dump() + "}";
    };
    EXPECT_EQ(echo_of(with(other))["example"]["name"], "other");
    std::swap(other["pieces"][0], other["pieces"][1]);
    EXPECT_EQ(pointers_of(with(other)), Pointers{"/example"});
    EXPECT_EQ(pointers_of(R"({"from": {"job": "a"}, "example": "city"})"), Pointers{"/example"});
}

TEST_F(Origin, AnExampleThatDoesNotFitMakesNoFaultsOfWhatTheJobAskedFor) {
    finish(
        "a",
        std::string(R"({"solver": "discrete", "parameters": {"boundary": {"top": "wall"}},
        "example": )") +
            kLine + "}"
    );
    EXPECT_EQ(
        pointers_of(R"({"from": {"job": "a"}, "example": "city", "parameters":
            {"weights": {"air": 2}}})"),
        (Pointers{"/example", "/parameters/weights/air"})
    );
}

TEST_F(Origin, AnotherSizeGetsItsOwnBlocksUnlessTheyWereChosen) {
    const auto blocks_at = [this](const std::string& before, const std::string& now) {
        finish(
            "a",
            R"({"solver": "discrete", "example": "castle", "parameters": {"size": [9, 8, 9])" +
                before + "}}"
        );
        return echo_from(
            "a", "", R"(, "parameters": {"size": [9, 12, 9])" + now + "}"
        )["parameters"]["blocks"];
    };
    EXPECT_EQ(blocks_at("", "")["size"], Json({10, 12, 10}));
    EXPECT_EQ(blocks_at("", R"(, "blocks": {"size": [5, 5, 5]})")["size"], Json({5, 5, 5}));
    const Json chosen = blocks_at(R"(, "blocks": {"size": [10, 8, 10], "passes": 2})", "");
    EXPECT_EQ(chosen["size"], Json({10, 8, 10}));
    EXPECT_EQ(chosen["passes"], 2);
    EXPECT_EQ(blocks_at(R"(, "blocks": null)", ""), nullptr);
}

TEST_F(Origin, TheSameSizeKeepsTheBlocks) {
    finish(
        "a", R"({"solver": "discrete", "example": "castle", "parameters": {"size": [9, 8, 9]}})"
    );
    const Json echo = echo_from("a", "", R"(, "parameters": {"size": [9, 8, 9]})");
    EXPECT_EQ(echo["parameters"]["blocks"]["size"], Json({10, 8, 10}));
}

TEST_F(Origin, ConstraintsGoWithTheirPlaces) {
    finish("a", R"({"solver": "discrete", "example": "castle", "parameters": {"size": [9, 8, 9],
        "constraints": [
        {"kind": "fixed", "pieces": ["grass"], "box": {"min": [0, 0, 0], "max": [2, 1, 2]}},
        {"kind": "fixed", "pieces": ["grass"], "cells": [[3, 0, 4], [8, 0, 8]]},
        {"kind": "path", "pieces": ["grass"], "from": [0, 0, 0], "to": [8, 0, 8]},
        {"kind": "count", "pieces": ["well"], "min": 1}]}})");
    const Json moved = echo_from(
        "a", R"(, "at": [5, 0, 2])", R"(, "parameters": {"size": [14, 8, 11]})"
    )["parameters"]["constraints"];
    EXPECT_EQ(moved[0]["box"], Json::parse(R"({"min": [5, 0, 2], "max": [7, 1, 4]})"));
    EXPECT_EQ(moved[1]["cells"], Json::parse("[[8, 0, 6], [13, 0, 10]]"));
    EXPECT_EQ(moved[2]["from"], Json({5, 0, 2}));
    EXPECT_EQ(moved[2]["to"], Json({13, 0, 10}));
    EXPECT_EQ(moved[3], Json::parse(jobs_["a"].echo)["parameters"]["constraints"][3]);
    // Those of the request itself are of the new model.
    const Json own = echo_from(
        "a", R"(, "at": [5, 0, 2])", R"(, "parameters": {"size": [14, 8, 11], "constraints":
        [{"kind": "fixed", "pieces": ["grass"], "cells": [[3, 0, 4]]}]})"
    )["parameters"]["constraints"];
    EXPECT_EQ(own[0]["cells"], Json::parse("[[3, 0, 4]]"));
}

TEST_F(Origin, ASymmetryStaysAboutTheMiddleOfTheModelItWasAskedOf) {
    finish("a", R"({"solver": "discrete", "example": "castle", "parameters": {"size": [9, 8, 9],
        "constraints": [{"kind": "symmetry", "rotate": 4}, {"kind": "symmetry", "reflect": "x",
        "box": {"min": [0, 0, 0], "max": [4, 8, 4]}},
        {"kind": "symmetry", "translate": [3, 0, 0]}]}})");
    const Json moved = echo_from(
        "a", R"(, "at": [5, 0, 2])", R"(, "parameters": {"size": [14, 8, 11]})"
    )["parameters"]["constraints"];
    EXPECT_EQ(moved[0]["box"], Json::parse(R"({"min": [5, 0, 2], "max": [14, 8, 11]})"));
    EXPECT_EQ(moved[1]["box"], Json::parse(R"({"min": [5, 0, 2], "max": [9, 8, 6]})"));
    EXPECT_FALSE(moved[2].contains("box"));
}

TEST_F(Origin, ConstraintsThatWereStretchedOverTheModelDoNotGoWithAnotherSize) {
    finish("a", R"({"solver": "discrete", "example": "castle", "parameters": {"size": [9, 8, 9],
        "constraints": [{"kind": "probability", "pieces": ["grass"], "weight": 2,
        "voxels": {"size": [1, 1, 1], "values": [1]}}]}})");
    EXPECT_TRUE(parse(R"({"from": {"job": "a"}})"));
    EXPECT_EQ(
        pointers_of(R"({"from": {"job": "a"}, "parameters": {"size": [10, 8, 9]}})"),
        Pointers{"/parameters/constraints"}
    );
    EXPECT_TRUE(
        parse(R"({"from": {"job": "a"}, "parameters": {"size": [10, 8, 9], "constraints": []}})")
    );
}

TEST_F(Origin, TheModelHasToLieInsideTheNewOne) {
    finish("a", R"({"solver": "discrete", "example": "castle", "parameters": {"size": [9, 8, 9],
        "constraints": [{"kind": "fixed", "pieces": ["grass"], "cells": [[8, 0, 8]]}]}})");
    const auto pointers_at = [this](const std::string& at, const std::string& size) {
        return pointers_of(
            R"({"from": {"job": "a", "at": )" + at + R"(}, "parameters": {"size": )" + size + "}}"
        );
    };
    EXPECT_EQ(pointers_at("[0, 0, 0]", "[9, 8, 9]"), Pointers());
    EXPECT_EQ(pointers_at("[1, 2, 3]", "[10, 10, 12]"), Pointers());
    EXPECT_EQ(pointers_at("[1, 0, 0]", "[9, 8, 9]"), Pointers{"/from/at"});
    EXPECT_EQ(pointers_at("[0, 3, 0]", "[10, 10, 12]"), Pointers{"/from/at"});
    EXPECT_EQ(pointers_at("[0, 0, 4096]", "[10, 10, 12]"), Pointers{"/from/at"});
    EXPECT_EQ(pointers_at("[0, 0, 0]", "[9, 8, 8]"), Pointers{"/parameters/size"});
    EXPECT_EQ(pointers_at("[1, 0, 0]", "[8, 8, 9]"), Pointers{"/parameters/size"});
    EXPECT_EQ(pointers_of(R"({"from": {"job": "a", "at": [0, 0, 1]}})"), Pointers{"/from/at"});
}

TEST_F(Origin, EveryFaultIsFoundAtOnce) {
    finish(
        "a", R"({"solver": "discrete", "example": "castle", "parameters": {"size": [9, 8, 9]}})"
    );
    EXPECT_EQ(
        pointers_of(R"({"solver": "x", "seed": -1, "from": {"job": "a", "size": [9, 8, 8],
            "at": [0, 0], "box": {"min": [0, 0, 0], "max": [10, 8, 9]}, "cells": [[9, 0, 0]],
            "region": 1}, "parameters": {"order": "up"}})"),
        (Pointers{
            "/solver",
            "/from/at",
            "/from/region",
            "/from/size",
            "/seed",
            "/parameters/order",
            "/from/box",
            "/from/cells/0"})
    );
}

TEST_F(Origin, WhatIsNoJobIsAFaultOfTheRequest) {
    for (const char* from : {"null", "\"a\"", "[]", "7"}) {
        EXPECT_EQ(pointers_of(std::string(R"({"from": )") + from + "}").at(0), "/from") << from;
    }
    for (const char* job : {"null", "7", "\"\"", "\"none\"", R"("a\u0000b")", R"(["a"])"}) {
        EXPECT_EQ(
            pointers_of(std::string(R"({"from": {"job": )") + job + "}}"), Pointers{"/from/job"}
        ) << job;
    }
    EXPECT_EQ(
        pointers_of(R"({"from": {"job": ")" + std::string(129, 'x') + "\"}}"), Pointers{"/from/job"}
    );
    EXPECT_EQ(pointers_of(R"({"from": {}})"), Pointers{"/from/job"});
}

TEST_F(Origin, AJobThatCannotBeStartedFromIsAnsweredWithItsProblemUnlessMoreIsWrong) {
    problems_ = {{"runs", "not-finished"}, {"old", "expired"}, {"failed", "no-model"}};
    for (const auto& [id, name] : problems_) {
        // Places cannot be judged while the model's size is not known.
        const std::string from = R"({"from": {"job": ")" + id + R"(", "cells": [[90, 0, 90]]})";
        const auto refused = parse(from + "}");
        ASSERT_FALSE(refused);
        EXPECT_EQ(refused.error().type, "/problems/" + name);
        ASSERT_EQ(refused.error().errors.size(), 1U);
        EXPECT_EQ(refused.error().errors[0].pointer, "/from/job");
        EXPECT_EQ(pointers_of(from + R"(, "seed": -1})"), (Pointers{"/seed", "/from/job"}));
    }
}

TEST_F(Origin, TwoRequestsThatAreTooMuchTogetherAreTooLarge) {
    finish("a", std::string(R"({"solver": "discrete", "example": )") + kLine + "}");
    RequestLimits limits;
    limits.json.nodes_max = 70;
    const std::string one = R"({"from": {"job": "a", "cells": [[0,0,0],[1,0,0],[2,0,0],[3,0,0],
        [4,0,0],[5,0,0],[6,0,0],[7,0,0],[8,0,0],[9,0,0]]}})";
    const auto refused = parse(one, limits);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().type, "/problems/too-large");
    EXPECT_EQ(refused.error().errors.at(0).pointer, "/from");
    EXPECT_TRUE(parse(one));
}

}  // namespace
}  // namespace modelsynth::proto
