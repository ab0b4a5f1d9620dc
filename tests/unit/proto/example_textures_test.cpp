// Textures of examples of solids: as JSON, as a file, and from the one to the other.

#include "proto/base64.h"
#include "proto/example_codec.h"
#include "proto/job_request.h"
#include "solver/continuous/reading/reading.h"
#include "solver/mesh/glb_writer.h"

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <string>
#include <variant>

namespace modelsynth::proto {
namespace {

std::string png_bytes(std::size_t more = 50) {
    return "\x89PNG\r\n\x1A\n" + std::string(more, 'p');
}

std::string png_uri(const std::string& bytes = png_bytes()) {
    return "data:image/png;base64," + encode_base64(bytes);
}

// `texture`: of the wall.
std::string wedge(const std::string& images, const std::string& texture) {
    return R"({"kind":"continuous","name":"wedge","images":[)" + images +
           R"(],"objects":[{"name":"wall","texture":)" + texture +
           R"(},{"name":"grass"}],"ground":"grass","spacing":1,"size":[6,4,6],"polyhedra":[)"
           R"({"object":"wall","vertices":[[0,0,0],[2,0,0],[0,1,0],[0,0,1],[2,0,1],[0,1,1]],)"
           R"("faces":[[0,2,1],[3,4,5],[0,1,4,3],[1,2,5,4],[0,3,5,2]]}]})";
}

std::string quoted(const std::string& text) { return "\"" + text + "\""; }

const continuous::Example& solids_of(const ExampleUpload& upload) {
    return std::get<std::shared_ptr<const continuous::ExampleReading>>(upload.example)->example();
}

std::string faults_of(const std::string& text) {
    const auto parsed = parse_example(text, {});
    std::string faults;
    if (!parsed) {
        for (const Fault& fault : parsed.error().errors) {
            faults += fault.pointer + ": " + fault.detail + "\n";
        }
    }
    return faults;
}

TEST(ExampleTextures, AreReadFromJson) {
    const auto upload = parse_example(wedge(quoted(png_uri()), R"({"image":0,"metres":0.5})"), {});
    ASSERT_TRUE(upload) << to_json(upload.error());
    const auto& texture = solids_of(*upload).materials[0].texture;
    ASSERT_TRUE(texture);
    EXPECT_EQ(texture->image->bytes, png_bytes());
    EXPECT_EQ(texture->repeat_m, 0.5);
    EXPECT_FALSE(solids_of(*upload).materials[1].texture);
}

TEST(ExampleTextures, AreKeptOfAFile) {
    const auto sent = parse_example(wedge(quoted(png_uri()), R"({"image":0,"metres":0.3})"), {});
    const std::string glb = *write_glb(example_scene(sent->example));
    const auto upload = parse_example_glb(glb, {});
    ASSERT_TRUE(upload) << to_json(upload.error());
    // As the server finds it again after a restart.
    const auto kept = parse_example(upload->canonical, {});
    ASSERT_TRUE(kept) << to_json(kept.error());
    EXPECT_EQ(kept->canonical, upload->canonical);
    const auto& texture = solids_of(*kept).materials[0].texture;
    ASSERT_TRUE(texture);
    EXPECT_EQ(texture->image->bytes, png_bytes());
    EXPECT_EQ(texture->repeat_m, 0.3);
    EXPECT_NE(write_glb(example_scene(kept->example))->find(png_bytes()), std::string::npos);
}

TEST(ExampleTextures, AreInTheResourceAndTheEchoButNotInTheList) {
    const std::string example = wedge(quoted(png_uri()), R"({"image":0})");
    const auto upload = parse_example(example, {});
    EXPECT_NE(example_resource(upload->example, "x", false).find(png_uri()), std::string::npos);
    EXPECT_EQ(example_summary(upload->example, "x", false).find("image"), std::string::npos);
    const auto request = parse_job_request(
        R"({"solver":"continuous","example":)" + example + "}",
        {},
        [](const std::string& /*id*/) { return std::optional<Example>(); },
        nullptr,
        1
    );
    ASSERT_TRUE(request) << to_json(request.error());
    EXPECT_NE(request->echo.find(png_uri()), std::string::npos);
}

TEST(ExampleTextures, AreSentOnceHoweverOftenTheyAreNamed) {
    const std::string two = quoted(png_uri()) + "," + quoted(png_uri());
    const auto upload = parse_example(wedge(two, R"({"image":1})"), {});
    ASSERT_TRUE(upload) << to_json(upload.error());
    const std::string resource = example_resource(upload->example, "x", false);
    EXPECT_NE(resource.find(R"("image":0)"), std::string::npos);
    EXPECT_EQ(resource.find(png_uri()), resource.rfind(png_uri()));
}

TEST(ExampleTextures, ThatMeanNothingAreFaults) {
    const std::string image = quoted(png_uri());
    const auto expect = [](const std::string& text, const std::string& fault) {
        EXPECT_EQ(faults_of(text), fault + "\n");
    };
    expect(wedge("", R"({"image":0})"), "/objects/0/texture/image: the example has no images");
    expect(
        wedge(image, R"({"image":1})"),
        "/objects/0/texture/image: must be a whole number from 0 to 0"
    );
    EXPECT_NE(
        faults_of(wedge(image, R"({"image":0,"metres":0})")).find("/objects/0/texture/metres: "),
        std::string::npos
    );
    EXPECT_NE(
        faults_of(wedge(image, R"({"image":0,"wide":1})")).find("/objects/0/texture/wide: "),
        std::string::npos
    );
    expect(
        wedge(R"("data:image/gif;base64,AAAA")", R"({"image":0})"),
        "/images/0: must be a data: URI of type image/png or image/jpeg in base64"
    );
    expect(
        wedge(R"("data:image/png;base64,AAA")", R"({"image":0})"),
        "/images/0: the data: URI is not base64"
    );
    expect(
        wedge(R"("data:image/jpeg;base64,AAAA")", R"({"image":0})"),
        "/images/0: the bytes are not image/jpeg"
    );
}

TEST(ExampleTextures, TogetherHaveALimit) {
    const std::size_t first = png_bytes().size();
    const std::size_t rest = kImageBytesMax - first - png_bytes(0).size();
    const auto with = [](std::size_t more) {
        return wedge(quoted(png_uri()) + "," + quoted(png_uri(png_bytes(more))), R"({"image":1})");
    };
    EXPECT_EQ(faults_of(with(rest)), "");
    EXPECT_EQ(faults_of(with(rest + 1)), "/images/1: the images have more than 16777216 bytes\n");
}

}  // namespace
}  // namespace modelsynth::proto
