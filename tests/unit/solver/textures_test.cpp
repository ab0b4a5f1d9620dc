// Textures of examples of solids, from a file to a file.

#include "solver/continuous/import/mesh_import.h"
#include "solver/continuous/reading/reading.h"
#include "solver/continuous/scene.h"
#include "solver/examples/solids/shapes.h"
#include "solver/mesh/glb_scene.h"
#include "solver/mesh/glb_writer.h"
#include "solver/mesh/gltf_document.h"
#include "solver/mesh/texture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace modelsynth::continuous {
namespace {

using examples::box;

std::span<const std::byte> bytes_of(const std::string& text) {
    return std::as_bytes(std::span(text));
}

// Files are not unpacked, so that all but the first bytes may be anything.
std::string png_bytes() { return "\x89PNG\r\n\x1A\n" + std::string(1229, 'p'); }

std::string jpeg_bytes() { return "\xFF\xD8\xFF" + std::string(320, 'j'); }

// Two objects share a picture, another one has one of its own, the last one has none.
Example make_example() {
    const auto png = std::make_shared<const Image>(Image{ImageFormat::kPng, png_bytes()});
    const auto jpeg = std::make_shared<const Image>(Image{ImageFormat::kJpeg, jpeg_bytes()});
    Example example;
    example.materials = {{"wall", {}}, {"roof", {}}, {"door", {}}, {"plain", {}}};
    example.materials[0].texture = Texture{png, 0.5};
    example.materials[1].texture = Texture{png, 1};
    example.materials[2].texture = Texture{jpeg, 2};
    example.objects = {{"wall", 0}, {"roof", 1}, {"door", 2}, {"plain", 3}};
    for (ObjectId object = 1; object <= 4; ++object) {
        const double x = 2.0 * object;
        example.polyhedra.push_back(box(object, {x, 0, 0}, {x + 1, 1, 1}));
    }
    return example;
}

std::string make_file(GlbProfile profile = GlbProfile::kNodes) {
    GlbOptions options;
    options.profile = profile;
    return *write_glb(make_example_scene(*ExampleReading::make(make_example()).value()), options);
}

std::string word(std::size_t value) {
    const auto number = static_cast<std::uint32_t>(value);
    return {reinterpret_cast<const char*>(&number), sizeof number};
}

// The file with something else in its JSON.
std::string changed(const std::string& glb, const std::string& from, const std::string& to) {
    std::uint32_t json_bytes = 0;
    std::memcpy(&json_bytes, glb.data() + 12, sizeof json_bytes);
    std::string json = glb.substr(20, json_bytes);
    const std::size_t at = json.find(from);
    EXPECT_NE(at, std::string::npos) << from << " is not in " << json;
    json.replace(at, from.size(), to);
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const std::string rest = glb.substr(20 + json_bytes);
    return "glTF" + word(2) + word(20 + json.size() + rest.size()) + word(json.size()) + "JSON" +
           json + rest;
}

std::string bytes_of_image(const tinygltf::Model& model, int texture) {
    const int source = model.textures.at(static_cast<std::size_t>(texture)).source;
    const tinygltf::Image& image = model.images.at(static_cast<std::size_t>(source));
    const auto& view = model.bufferViews.at(static_cast<std::size_t>(image.bufferView));
    const auto& data = model.buffers.at(0).data;
    const auto begin = data.begin() + static_cast<std::ptrdiff_t>(view.byteOffset);
    return {begin, begin + static_cast<std::ptrdiff_t>(view.byteLength)};
}

TEST(Textures, AreWrittenOnceAndRepeated) {
    for (const auto profile : {GlbProfile::kNodes, GlbProfile::kMerged}) {
        const auto model = parse_glb(bytes_of(make_file(profile)), {});
        ASSERT_TRUE(model) << model.error().message;
        ASSERT_EQ(model->images.size(), 2U);
        EXPECT_EQ(model->images[0].mimeType, "image/png");
        EXPECT_EQ(model->images[1].mimeType, "image/jpeg");
        ASSERT_EQ(model->samplers.size(), 1U);
        EXPECT_EQ(model->samplers[0].wrapS, TINYGLTF_TEXTURE_WRAP_REPEAT);
        EXPECT_EQ(model->samplers[0].wrapT, TINYGLTF_TEXTURE_WRAP_REPEAT);
        ASSERT_EQ(model->materials.size(), 4U);
        std::vector<std::string> images;
        for (const tinygltf::Material& material : model->materials) {
            const int texture = material.pbrMetallicRoughness.baseColorTexture.index;
            images.push_back(texture < 0 ? "" : bytes_of_image(*model, texture));
        }
        EXPECT_EQ(images, (std::vector{png_bytes(), png_bytes(), jpeg_bytes(), std::string()}));
        EXPECT_TRUE(model->extensionsUsed.empty());
    }
}

TEST(Textures, OfMaterialsThatNothingHasAreLeftOut) {
    Example example = make_example();
    example.polyhedra.erase(example.polyhedra.begin(), example.polyhedra.begin() + 2);
    const Scene scene = make_example_scene(*ExampleReading::make(example).value());
    const auto model = parse_glb(bytes_of(*write_glb(scene)), {});
    ASSERT_TRUE(model);
    ASSERT_EQ(model->images.size(), 1U);
    EXPECT_EQ(bytes_of_image(*model, 0), jpeg_bytes());
}

TEST(Textures, CoordinatesAreInRepeats) {
    const Scene scene = make_example_scene(*ExampleReading::make(make_example()).value());
    std::vector<float> heights;
    for (const Primitive& part : scene.kit->meshes.front().primitives) {
        float low = 1e9F;
        for (const Vec2& at : part.texture_coordinates) {
            low = std::min(low, at.y);
        }
        heights.push_back(-low);  // of walls that are one metre high
    }
    EXPECT_EQ(heights, (std::vector<float>{2, 1, 0.5F, 1}));
}

TEST(Textures, ComeBackFromAFile) {
    const auto read = read_example_glb(bytes_of(make_file()));
    ASSERT_TRUE(read) << read.error().message;
    const Example* const example = &read->example;
    ASSERT_EQ(example->materials.size(), 4U);
    for (const std::size_t i : {0U, 1U, 2U}) {
        ASSERT_TRUE(example->materials[i].texture) << i;
    }
    EXPECT_EQ(example->materials[0].texture->image->bytes, png_bytes());
    EXPECT_EQ(example->materials[0].texture->repeat_m, 0.5);
    EXPECT_EQ(example->materials[1].texture->image, example->materials[0].texture->image);
    EXPECT_EQ(example->materials[1].texture->repeat_m, 1);
    EXPECT_EQ(example->materials[2].texture->image->bytes, jpeg_bytes());
    EXPECT_EQ(example->materials[2].texture->image->format, ImageFormat::kJpeg);
    EXPECT_FALSE(example->materials[3].texture);
}

TEST(Textures, RepeatEveryMetreIfNothingIsSaid) {
    const std::string silent = changed(make_file(), R"("metres":0.5)", R"("other":0.5)");
    EXPECT_EQ(read_example_glb(bytes_of(silent))->example.materials[0].texture->repeat_m, 1);
}

TEST(Textures, EqualImagesAreTheSame) {
    // The second picture of the file becomes another name for the first one.
    const auto model = parse_glb(bytes_of(make_file()), {});
    const auto view = [&](std::size_t image, const char* type) {
        return "\"bufferView\":" + std::to_string(model->images[image].bufferView) +
               ",\"mimeType\":\"" + type + "\"";
    };
    const std::string twice = changed(make_file(), view(1, "image/jpeg"), view(0, "image/png"));
    const auto read = read_example_glb(bytes_of(twice));
    ASSERT_TRUE(read) << read.error().message;
    const Example* const example = &read->example;
    EXPECT_EQ(example->materials[2].texture->image, example->materials[0].texture->image);
}

TEST(Textures, ThatCannotBeReadAreRefusedWithTheirPlace) {
    const std::string png = R"("mimeType":"image/png")";
    const auto model = parse_glb(bytes_of(make_file()), {});
    const std::string view =
        "\"bufferView\":" + std::to_string(model->images[0].bufferView) + "," + png;
    const std::string length = "\"byteLength\":" + std::to_string(png_bytes().size());

    struct Case {
        std::string from;
        std::string to;
        std::string said;
    };

    for (const Case& one : std::vector<Case>{
             {R"("index":0)", R"("index":7)", R"(material "wall": there is no texture 7)"},
             {R"("source":0)", R"("source":9)", R"(material "wall": image 9 does not exist)"},
             {R"("source":0)", R"("name":"x")", R"(material "wall": image -1 does not exist)"},
             {view, "\"bufferView\":99," + png, "image[0] bufferView \"99\" not found"},
             {view, "\"bufferView\":-1," + png, "image 0 is not embedded in a buffer view"},
             {view, R"("uri":"data:image/png;base64,iVBORw0KGgo=")", "image 0 is not embedded"},
             {view, R"("uri":"brick.png")", "image 0 is not embedded in a buffer view"},
             {length, R"("byteLength":99999)", "image 0 reaches beyond its buffer"},
             {length, R"("byteLength":18446744073709551615)", "GLB: "},
             {length, R"("byteLength":7)", "image 0 is neither a PNG nor a JPEG"},
             {png, R"("mimeType":"image/webp")", "image 0 is image/png, which is not what"},
             {png, R"("name":"x")", "image 0 is image/png, which is not what"},
             {R"("metres":0.5)", R"("metres":0)", R"(material "wall": extras.metres is not)"},
             {R"("metres":0.5)", R"("metres":1e9)", R"(material "wall": extras.metres is not)"},
             {R"("metres":0.5)", R"("metres":"wide")", "extras.metres is not a number"},
             {R"("name":"plain")",
              R"("name":"plain","normalTexture":{"index":0})",
              R"(material "plain" has a texture of another kind than base colours)"}}) {
        const auto example = read_example_glb(bytes_of(changed(make_file(), one.from, one.to)));
        ASSERT_FALSE(example) << one.to;
        EXPECT_EQ(example.error().code, ErrorCode::kInvalidArgument);
        EXPECT_NE(example.error().message.find(one.said), std::string::npos)
            << one.to << ": " << example.error().message;
    }
}

TEST(Textures, TogetherHaveALimit) {
    const std::string file = make_file();
    GlbReadLimits limits;
    limits.image_bytes_max = png_bytes().size() + jpeg_bytes().size();
    EXPECT_TRUE(read_glb_scene(bytes_of(file), limits));
    --limits.image_bytes_max;
    const auto scene = read_glb_scene(bytes_of(file), limits);
    ASSERT_FALSE(scene);
    EXPECT_EQ(scene.error().code, ErrorCode::kTooLarge);
    EXPECT_NE(scene.error().message.find("material \"door\": image 1"), std::string::npos);
}

TEST(Textures, OfPiecesAreRefused) {
    const auto kit = read_glb(bytes_of(make_file()));
    ASSERT_FALSE(kit);
    EXPECT_NE(kit.error().message.find("\"wall\" has a texture; only plain"), std::string::npos);
}

}  // namespace
}  // namespace modelsynth::continuous
