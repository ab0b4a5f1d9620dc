// Every parser on texts that were valid once: bytes changed, cut, doubled, moved. Nothing may
// crash, hang or be read out of bounds (the sanitizers watch), and what is accepted must be whole.
// MODELSYNTH_FUZZ_ROUNDS asks for a longer run.

#include "proto/example_codec.h"
#include "proto/frame.h"
#include "proto/image_mask.h"
#include "proto/job_request.h"
#include "proto/stream_message.h"
#include "server/http/content_coding.h"
#include "server/http/head_check.h"
#include "server/http/message.h"
#include "solver/continuous/scene.h"
#include "solver/core/random.h"
#include "solver/discrete/scene.h"
#include "solver/examples/built_in.h"
#include "solver/examples/solids/built_in_solids.h"
#include "solver/mesh/glb_reader.h"
#include "solver/mesh/glb_scene.h"
#include "solver/mesh/glb_writer.h"
#include "tests/support/png_file.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace modelsynth {
namespace {

std::uint64_t rounds() {
    const char* asked = std::getenv("MODELSYNTH_FUZZ_ROUNDS");
    return asked == nullptr ? 3000 : std::strtoull(asked, nullptr, 10);
}

std::string mutate(std::string text, RandomStream& random) {
    static const std::vector<std::string> kPieces = {
        "{",
        "}",
        "[",
        "]",
        "\"",
        ":",
        ",",
        "null",
        "-1",
        "1e400",
        "18446744073709551616",
        "true",
        "\\u0000",
        "\xFF",
        std::string(1, '\0'),
        "%00",
        "..",
        "\r\n",
        "0.5",
        "[[[[[[[["};
    const auto below = [&random](std::size_t bound) {
        return static_cast<std::size_t>(random.below(static_cast<std::uint32_t>(bound)));
    };
    for (std::size_t i = 0; i <= below(4) && !text.empty(); ++i) {
        const std::size_t at = below(text.size());
        const std::size_t length = 1 + below(std::min<std::size_t>(16, text.size() - at));
        switch (below(5)) {
            case 0:
                text[at] = static_cast<char>(random.next());
                break;
            case 1:
                text.erase(at, length);
                break;
            case 2:
                text.insert(at, text.substr(below(text.size()), length));
                break;
            case 3:
                text.replace(at, length, kPieces[below(kPieces.size())]);
                break;
            default:
                text.resize(at);
                break;
        }
    }
    return text;
}

void fuzz(
    const std::string& seed_text,
    std::uint32_t purpose,
    const std::function<bool(const std::string&)>& accepts
) {
    std::size_t accepted = 0;
    for (std::uint64_t round = 0; round < rounds(); ++round) {
        RandomStream random({round, 0, 0, purpose});
        accepted += accepts(mutate(seed_text, random)) ? 1U : 0U;
    }
    EXPECT_TRUE(accepts(seed_text));
    EXPECT_LT(accepted, rounds());  // mutations that never matter test nothing
}

std::optional<Example> find_nothing(const std::string& /*id*/) { return std::nullopt; }

// What is accepted is echoed in a form that is accepted again and says the same; what is not is
// told why.
std::optional<proto::JobRequest> read_request(
    const std::string& text, const proto::FindOrigin& find_origin = nullptr
) {
    auto parsed = proto::parse_job_request(text, {}, find_nothing, find_origin, 1);
    if (!parsed) {
        EXPECT_FALSE(proto::to_json(parsed.error()).empty());
        return std::nullopt;
    }
    const auto again = proto::parse_job_request(parsed->echo, {}, find_nothing, nullptr, 2);
    EXPECT_TRUE(again && again->echo == parsed->echo) << text;
    return std::move(*parsed);
}

class Silent final : public Observer {
  public:
    void on_start(std::uint32_t, std::span<const Label>) override {}

    void on_block(const BlockReport&) override {}
};

// Makes a small model of what was accepted, or it is told why there is none.
bool is_made(const Task& task) {
    constexpr std::size_t kMadeCellsMax = 1000;
    if (model_size(task.parameters).cell_count() > kMadeCellsMax) {
        return false;
    }
    Preparations preparations;
    Silent observer;
    const auto finished = run(task, preparations, observer, {});
    EXPECT_TRUE(finished || !finished.error().message.empty());
    return finished.has_value();
}

// What is accepted of a request can be made or is refused with a reason.
void fuzz_request(const std::string& request, std::uint32_t seed) {
    std::size_t made = 0;
    fuzz(request, seed, [&](const std::string& text) {
        const auto parsed = read_request(text);
        if (!parsed) {
            return false;
        }
        made += is_made(parsed->task) ? 1U : 0U;
        return true;
    });
    EXPECT_GT(made, 1U);  // the request as it stands, and others
}

constexpr const char* kExample = R"({"kind":"discrete","name":"line","cell":[1,1,1],
"pieces":[{"name":"empty"},{"name":"ground"},{"name":"wall","weight":2,"turns":1}],"size":[2,2,2],
"cells":[1,1,1,1,0,2,0,0],"empty":"empty","adjacency":{"x":[["wall","wall"]]},
"boundary":{"bottom":"example","top":["empty"],"north":"periodic","south":"periodic"}})";

TEST(Fuzz, JobRequests) {
    std::string request = R"({"solver":"discrete","example":)";
    request += kExample;
    request +=
        R"(,"seed":7,"parameters":{"size":[4,3,2],"blocks":{"size":[2,2,2],"overlap":0.5},)"
        R"("boundary":{"top":"empty"},"order":"scan","weights":{"wall":3},)"
        R"("constraints":[{"kind":"fixed","pieces":["wall"],"box":{"min":[0,1,0],"max":[1,2,1]}}]},)"
        R"("priority":1,"deadline":2.5,"tags":{"a":"b"}})";
    fuzz(request, 1, [](const std::string& text) { return read_request(text).has_value(); });
}

// What is accepted of constraints can be made, or is refused with a reason.
TEST(Fuzz, Constraints) {
    std::string request = R"({"solver":"discrete","example":)";
    request += kExample;
    request +=
        R"(,"seed":7,"parameters":{"size":[4,2,4],"blocks":{"size":[2,2,2]},"weights":"uniform",)"
        R"("boundary":{"bottom":"free","top":"free","north":"free","south":"free"},"constraints":[)"
        R"({"kind":"probability","pieces":["wall"],"weight":2.5,"mask":")"
        "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAABAAAAAQCAAAAAA6mKC9AAAAMUlEQ"
        "VR4nGNgIAb8//8fiQIzQEwoBWXAAVECDOh8ZBEke1H4MBE0t6HwQSJEeQorAADMnWOd53M09AAA"
        "AABJRU5ErkJggg=="
        R"("},)"
        R"({"kind":"forbidden","pieces":["empty"],"cells":[[0,0,0],[1,0,1]]},)"
        R"({"kind":"count","pieces":["wall"],"min":1,"max":9},)"
        R"({"kind":"separation","pieces":["wall"],"distance":2},)"
        R"({"kind":"max_run","pieces":["ground"],"max":7,"axis":"x"},)"
        R"({"kind":"connected","pieces":["ground","wall"]},)"
        R"({"kind":"acyclic","pieces":["wall"],"box":{"min":[0,1,0],"max":[3,2,3]}},)"
        R"({"kind":"path","pieces":["ground"],"from":[0,0,0],"to":[3,0,1]},)"
        R"({"kind":"fixed","pieces":["ground"],"voxels":{"size":[1,2,1],"values":[0.75,0]}}]}})";
    fuzz_request(request, 8);
}

// What is accepted of a start from another job tells all of it, and can be made or is refused with
// a reason.
TEST(Fuzz, JobsThatStartFromAnother) {
    const auto earlier = proto::parse_job_request(
        std::string(R"({"solver":"discrete","example":)") + kExample +
            R"(,"seed":7,"parameters":{"size":[4,2,4],"blocks":{"size":[2,2,2]},"boundary":)"
            R"({"bottom":"free","top":"free","north":"free","south":"free"},"constraints":[)"
            R"({"kind":"fixed","pieces":["ground"],"cells":[[3,0,3]]},)"
            R"({"kind":"path","pieces":["ground"],"from":[0,0,0],"to":[3,0,3]}]}})",
        {},
        find_nothing,
        nullptr,
        1
    );
    ASSERT_TRUE(earlier) << proto::to_json(earlier.error());
    Preparations preparations;
    Silent observer;
    const auto first = run(earlier->task, preparations, observer, {});
    ASSERT_TRUE(first) << first.error().message;
    const auto find = [&earlier](
                          const std::string& id, std::uint32_t alternative
                      ) -> proto::Parsed<proto::JobRequest> {
        if (id == "a" && alternative < 5) {
            return *earlier;
        }
        return tl::unexpected(proto::make_problem("not-found", "there is no such job"));
    };
    constexpr std::size_t kMadeCellsMax = 1000;
    std::size_t made = 0;
    const std::string request =
        R"({"from":{"job":"a","alternative":4,"size":[4,2,4],"at":[1,0,0],"box":{"min":[2,0,1],"max":[4,2,3]},)"
        R"("cells":[[0,0,0],[1,1,3]],"voxels":{"size":[1,1,2],"values":[0.75,0]}},"seed":3,)"
        R"("parameters":{"size":[6,2,5],"order":"random","weights":{"wall":3}},"alternatives":2,"priority":1})";
    fuzz(request, 9, [&](const std::string& text) {
        const auto parsed = read_request(text, find);
        if (!parsed) {
            return false;
        }
        if (model_size(parsed->task.parameters).cell_count() <= kMadeCellsMax) {
            Task task = parsed->task;
            if (parsed->from) {
                Origin origin = parsed->from->origin;
                std::get<discrete::Origin>(origin).labels = first->model.labels;
                task.origin = std::make_shared<const Origin>(std::move(origin));
            }
            const auto finished = run(task, preparations, observer, {});
            EXPECT_TRUE(finished || !finished.error().message.empty());
            made += finished ? 1U : 0U;
        }
        return true;
    });
    EXPECT_GT(made, 1U);  // the request as it stands, and others
}

TEST(Fuzz, Examples) {
    fuzz(kExample, 2, [](const std::string& text) {
        const auto parsed = proto::parse_example(text, {});
        if (parsed) {
            const auto* grid =
                std::get_if<std::shared_ptr<const discrete::Example>>(&parsed->example);
            EXPECT_TRUE(grid != nullptr);
            EXPECT_EQ((*grid)->cells.size(), (*grid)->size.cell_count());
            EXPECT_TRUE(write_glb(discrete::make_piece_sheet(**grid)));
        }
        return parsed.has_value();
    });
}

constexpr const char* kWedge =
    R"({"kind":"continuous","name":"wedge","objects":[)"
    R"({"name":"grass","color":[0.2,0.4,0.1]},{"name":"wall","weight":2}],)"
    R"("ground":"grass","spacing":1,"size":[6,4,6],"density":0.4,)"
    R"("dimensions":[{"object":"wall","normal":[0,0,1]}],"connected":[["wall","grass"]],)"
    R"("bounds":{"min":[-9,-9,-9],"max":[9,9,9]},"polyhedra":[{"name":"w",)"
    R"("object":"wall","vertices":[[0,0,0],[2,0,0],[0,1,0],[0,0,1],[2,0,1],)"
    R"([0,1,1]],"faces":[[0,2,1],[3,4,5],[0,1,4,3],[1,2,5,4],[0,3,5,2]]}]})";

// What is accepted of solids can be made, and is told in a form that is accepted again.
TEST(Fuzz, Solids) {
    const std::string request =
        std::string(R"({"solver":"continuous","example":)") + kWedge +
        R"(,"seed":7,"parameters":{"size":[5,3.5,6],"blocks":{"size":[4,4,4]},)"
        R"("spacing":[{"normal":[0,1,0],"spacing":0.75},{"spacing":1}],)"
        R"("offsets":[{"normal":[0,0,1],"offsets":[0.5,2,4.25]}],)"
        R"("density":0.5,"weights":{"wall":3},"constraints":[{"kind":"dimension","object":"wall",)"
        R"("normal":[0,0,1]}]},"tags":{}})";
    fuzz_request(request, 11);
    fuzz(kWedge, 12, [](const std::string& text) {
        return proto::parse_example(text, {}).has_value();
    });
}

// What is accepted of their constraints, too.
TEST(Fuzz, ConstraintsOfSolids) {
    std::string request = R"({"solver":"continuous","example":)";
    request += kWedge;
    request +=
        R"(,"seed":7,"parameters":{"size":[5,3,6],"blocks":{"size":[4,4,4]},"constraints":[)"
        R"({"kind":"dimension","object":"wall","normal":[0,0,1],"spacings":2},)"
        R"({"kind":"connected","objects":["wall","grass"],"components":2},)"
        R"({"kind":"fixed","objects":["empty","grass"],"box":{"min":[3,0,0],"max":[5,3,6]}},)"
        R"({"kind":"forbidden","objects":["wall"],"voxels":{"size":[1,2,1],"values":[0,1]}},)"
        R"({"kind":"probability","objects":["wall"],"weight":2.5,"mask":")"
        "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAABAAAAAQCAAAAAA6mKC9AAAAMUlEQ"
        "VR4nGNgIAb8//8fiQIzQEwoBWXAAVECDOh8ZBEke1H4MBE0t6HwQSJEeQorAADMnWOd53M09AAA"
        "AABJRU5ErkJggg=="
        R"("}]}})";
    fuzz_request(request, 16);
}

TEST(Fuzz, SolidsInBinaryGltf) {
    const auto wedge = proto::parse_example(kWedge, {});
    ASSERT_TRUE(wedge);
    const std::string glb = *write_glb(example_scene(wedge->example));
    fuzz(glb, 13, [](const std::string& text) {
        const auto parsed = proto::parse_example_glb(text, {});
        EXPECT_TRUE(parsed || !proto::to_json(parsed.error()).empty());
        return parsed.has_value();
    });
}

// A file as the writer makes it, with these members added to each of its elements of a kind.
std::string with_extras(
    std::string glb, const std::vector<std::pair<std::string, std::string>>& added
) {
    std::uint32_t size = 0;
    std::memcpy(&size, glb.data() + 12, sizeof size);
    std::string json = glb.substr(20, size);
    for (const auto& [before, members] : added) {
        const std::size_t at = json.find(before);
        EXPECT_NE(at, std::string::npos) << before << " in " << json;
        if (at == std::string::npos) {
            continue;
        }
        json.insert(at + before.size(), members);
    }
    json.resize((json.size() + 3) / 4 * 4, ' ');
    glb.replace(20, size, json);
    const auto put = [&glb](std::size_t at, std::size_t value) {
        const auto word = static_cast<std::uint32_t>(value);
        std::memcpy(glb.data() + at, &word, sizeof word);
    };
    put(12, json.size());
    put(8, glb.size());
    return glb;
}

// A box, and what is a shape, a moulding and a knob by its extras.
std::string box_with_attachments() {
    const auto mesh = [](const char* name, const std::vector<Vec3>& corners) {
        Primitive primitive;
        for (const Vec3& corner : corners) {
            primitive.indices.push_back(static_cast<std::uint32_t>(primitive.positions.size()));
            primitive.positions.push_back(corner);
        }
        primitive.normals.resize(corners.size(), {0, 1, 0});
        primitive.colors.resize(corners.size(), {255, 255, 255});
        return Mesh{name, {primitive}};
    };
    const Vec3 o = {0, 0, 0};
    const Vec3 x = {1, 0, 0};
    const Vec3 y = {0, 1, 0};
    const Vec3 z = {0, 0, 1};
    const std::array<Vec3, 8> c = {{o, x, {1, 1, 0}, y, z, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}};
    std::vector<Vec3> cube;
    for (const auto& [i, j, k, l] : std::vector<std::array<std::size_t, 4>>{
             {0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}) {
        cube.insert(cube.end(), {c[i], c[j], c[k], c[i], c[k], c[l]});
    }
    auto kit = std::make_shared<Kit>();
    kit->materials = {{"wall", {}}};
    kit->meshes = {
        mesh("cube", cube),
        mesh("gem", {o, y, x, o, z, y, o, x, z, x, y, z}),
        mesh("flat", {o, x, y})};
    Scene scene;
    scene.kit = kit;
    scene.names = {"house", "shape", "moulding", "knob"};
    for (std::uint32_t node = 0; node < 4; ++node) {
        const std::uint32_t of_mesh = node == 3 ? 1 : node;
        scene.groups.push_back({"", {{of_mesh, node, {0, 0, 0}, 0}}});
    }
    return with_extras(
        *write_glb(scene),
        {{R"("scenes":[{)",
          R"("extras":{"spacing":1,"size":[6,4,6],"density":0.4,"name":"walls","connected":)"
          R"("[[\"wall\"]]","dimensions":[{"object":"wall","normal":[0,0,1]}],"bounds":)"
          R"({"min":[-9,-9,-9],"max":[9,9,9]},"constraints":[{"kind":"forbidden","objects":)"
          R"(["wall"],"box":{"min":[0,0,0],"max":[1,1,1]}}]},)"},
         {R"("materials":[{)",
          R"("extras":{"weight":2,"decorations":"[{\"edges\":[\"up\",\"side\"],\"profile\":)"
          R"([[0,0],[0.1,0],[0.1,0.1]]}]"},)"},
         {R"("piece":"shape")", R"(,"shape":"wall","even":"x z","smooth":30)"},
         {R"("piece":"moulding")", R"(,"decorates":"wall","edges":"up side","turn":"convex")"},
         {R"("piece":"knob")",
          R"(,"decorates":"wall","corners":"any up any","turned":1,"smooth":0)"}}
    );
}

// What the extras of a GLB say is refused with its place, or can be told as JSON again. It is the
// JSON that is changed.
TEST(Fuzz, ExtrasOfBinaryGltf) {
    const std::string glb = box_with_attachments();
    const auto whole = proto::parse_example_glb(glb, {});
    ASSERT_TRUE(whole) << proto::to_json(whole.error());
    std::uint32_t size = 0;
    std::memcpy(&size, glb.data() + 12, sizeof size);
    std::size_t at_places = 0;
    for (std::uint64_t round = 0; round < rounds(); ++round) {
        RandomStream random({round, 0, 0, 17});
        std::string json = glb.substr(20, size);
        json = mutate(std::move(json), random);
        std::string changed =
            glb.substr(0, 20) + json + std::string((4 - json.size() % 4) % 4, ' ');
        const auto json_size = static_cast<std::uint32_t>(changed.size() - 20);
        changed += glb.substr(20 + size);
        const auto whole_size = static_cast<std::uint32_t>(changed.size());
        std::memcpy(changed.data() + 12, &json_size, sizeof json_size);
        std::memcpy(changed.data() + 8, &whole_size, sizeof whole_size);
        const auto parsed = proto::parse_example_glb(changed, {});
        if (parsed) {
            EXPECT_TRUE(proto::parse_example(parsed->canonical, {})) << parsed->canonical;
            continue;
        }
        for (const Fault& fault : parsed.error().errors) {
            const bool is_in_file = fault.pointer.empty() || fault.pointer.starts_with("/nodes/") ||
                                    fault.pointer.starts_with("/materials/") ||
                                    fault.pointer.starts_with("/scenes/") ||
                                    fault.pointer.starts_with("/asset/");
            EXPECT_TRUE(is_in_file) << fault.pointer << ": " << fault.detail;
            at_places += fault.pointer.find("/extras/") != std::string::npos ? 1U : 0U;
        }
    }
    EXPECT_GT(at_places, 0U);
}

// A small file that passes for a PNG.
constexpr const char* kPngUri = "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAABAAAAAQCAAA";

std::string textured_wedge() {
    std::string text = kWedge;
    const std::string before = R"("name":"wall",)";
    text.insert(text.find(before) + before.size(), R"("texture":{"image":0,"metres":0.5},)");
    text.insert(1, R"("images":[")" + std::string(kPngUri) + R"("],)");
    return text;
}

// Whatever is made of textures, a file with them is one that is taken.
bool is_textured_example(const proto::Parsed<proto::ExampleUpload>& parsed) {
    if (parsed) {
        const auto glb = write_glb(example_scene(parsed->example));
        EXPECT_TRUE(glb);
        EXPECT_TRUE(glb && read_glb_scene(std::as_bytes(std::span(*glb))));
    }
    return parsed.has_value();
}

TEST(Fuzz, Textures) {
    fuzz(textured_wedge(), 14, [](const std::string& text) {
        return is_textured_example(proto::parse_example(text, {}));
    });
    const auto wedge = proto::parse_example(textured_wedge(), {});
    ASSERT_TRUE(wedge) << proto::to_json(wedge.error());
    fuzz(*write_glb(example_scene(wedge->example)), 15, [](const std::string& text) {
        return is_textured_example(proto::parse_example_glb(text, {}));
    });
}

TEST(Fuzz, BinaryGltf) {
    auto castle = *examples::built_in().front();
    castle.pieces.resize(4);
    GlbOptions options;
    options.named_nodes = true;
    const std::string glb = *write_glb(discrete::make_piece_sheet(castle), options);
    fuzz(glb, 3, [](const std::string& text) {
        const auto kit = read_glb(std::as_bytes(std::span(text)));
        for (std::size_t i = 0; kit && i < kit->meshes.size(); ++i) {
            for (const Primitive& primitive : kit->meshes[i].primitives) {
                EXPECT_LT(primitive.material, kit->materials.size());
                for (const std::uint32_t index : primitive.indices) {
                    EXPECT_LT(index, primitive.positions.size());
                }
            }
        }
        return kit.has_value();
    });
}

TEST(Fuzz, Frames) {
    const std::string frame = proto::encode_frame(
        {proto::FrameKind::kLabels,
         5,
         {{0, 0, 0}, {1, 2, 1}},
         proto::encode_labels(std::vector<Label>{1, 2})}
    );
    fuzz(frame, 4, [](const std::string& text) {
        const auto decoded = proto::decode_frame(text);
        if (decoded) {
            EXPECT_EQ(proto::encode_frame(*decoded), text);
        }
        return decoded.has_value();
    });
}

TEST(Fuzz, FramesThatNameTheirJob) {
    const proto::Frame frame = {
        proto::FrameKind::kLabels,
        5,
        {{0, 0, 0}, {1, 2, 1}},
        proto::encode_labels(std::vector<Label>{1, 2})};
    fuzz(
        proto::encode_frame_head(frame, "job42") + frame.payload,
        106,
        [](const std::string& text) {
            const auto decoded = proto::decode_named_frame(text);
            if (decoded) {
                EXPECT_EQ(
                    proto::encode_frame_head(decoded->frame, decoded->job_id) +
                        decoded->frame.payload,
                    text
                );
            }
            return decoded.has_value();
        }
    );
}

TEST(Fuzz, StreamRequests) {
    const std::string request =
        R"({"id": "a", "type": "subscribe", "job": "j1", "after": 3, "partial": "glb"})";
    fuzz(request, 107, [](const std::string& text) {
        const auto read = proto::parse_stream_request(text);
        if (!read) {
            EXPECT_FALSE(proto::refusal_json(read.error()).empty());
        }
        return read.has_value();
    });
}

bool is_mask(const std::string& text) {
    const auto image = proto::decode_mask(text);
    if (image) {
        EXPECT_GT(image->width, 0);
        EXPECT_GT(image->height, 0);
        EXPECT_EQ(
            image->values.size(),
            static_cast<std::size_t>(image->width) * static_cast<std::size_t>(image->height)
        );
    } else {
        EXPECT_FALSE(image.error().message.empty());
    }
    return image.has_value();
}

// A palette with transparent colours and indices below a byte, and samples of 16 bits with alpha.
std::vector<std::string> masks() {
    testing::PngPicture palette{
        .width = 9, .height = 7, .color_type = PNG_COLOR_TYPE_PALETTE, .bit_depth = 2};
    testing::PngPicture colours{
        .width = 9, .height = 7, .color_type = PNG_COLOR_TYPE_RGB_ALPHA, .bit_depth = 16};
    RandomStream random({0, 0, 0, 6});
    for (std::size_t i = 0; i < 9 * 7; ++i) {
        palette.samples.push_back(random.below(3));
        for (std::size_t channel = 0; channel < 4; ++channel) {
            colours.samples.push_back(random.below(65536));
        }
    }
    palette.palette = {{0, 0, 0}, {255, 0, 0}, {9, 99, 199}};
    palette.palette_alphas = {0, 128};
    palette.is_interlaced = true;
    return {testing::write_png(palette), testing::write_png(colours)};
}

TEST(Fuzz, Masks) {
    for (const std::string& png : masks()) {
        fuzz(testing::png_uri(png), 6, is_mask);
    }
}

TEST(Fuzz, MasksBehindTrueChecksums) {
    for (const std::string& png : masks()) {
        fuzz(png, 7, [](const std::string& changed) {
            return is_mask(testing::png_uri(testing::with_true_checksums(changed)));
        });
    }
}

TEST(Fuzz, RequestTargetsAndHeads) {
    const std::string head =
        "GET /v1/jobs/01abc/events?after=3&partial=labels%20x HTTP/1.1\r\nHost: x\r\n\r\n";
    fuzz(head, 5, [](const std::string& text) {
        server::Request request;
        const std::size_t space = text.find(' ');
        const std::string target =
            space == std::string::npos
                ? text
                : text.substr(space + 1, text.find(' ', space + 1) - space - 1);
        const bool fine = server::parse_target(target, request);
        return fine && !server::check_raw_head(text);
    });
}

// Found by tests/fuzz/targets/request_head.cpp: only an escaped one was refused.
TEST(Fuzz, TargetsWithNulBytes) {
    using namespace std::string_literals;
    for (const std::string& target : {"/a\0b"s, "/a%00b"s, "/a?b\0=c"s, "/a?b=c\0"s}) {
        server::Request request;
        EXPECT_FALSE(server::parse_target(target, request));
    }
}

TEST(Fuzz, AcceptedCodings) {
    fuzz("gzip;q=0.875, identity ; q=0.25,br;q=1.000 , *;q=0", 17, [](const std::string& text) {
        const auto accepted = server::parse_accept_encoding(text);
        EXPECT_TRUE(accepted.gzip || !accepted.prefers_gzip);
        return accepted.gzip;
    });
}

}  // namespace
}  // namespace modelsynth
