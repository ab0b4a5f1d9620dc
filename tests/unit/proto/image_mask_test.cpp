#include "proto/image_mask.h"

#include "solver/core/random.h"
#include "tests/support/png_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace modelsynth::proto {
namespace {

using modelsynth::testing::big_endian;
using modelsynth::testing::png_uri;
using modelsynth::testing::PngPicture;
using modelsynth::testing::with_chunk;
using modelsynth::testing::with_true_checksums;
using modelsynth::testing::write_png;

using Values = std::vector<std::uint8_t>;

// Every kind of pixel that a PNG may have: colour type, bit depth.
const std::vector<std::pair<int, int>> kKinds = {
    {PNG_COLOR_TYPE_GRAY, 1},
    {PNG_COLOR_TYPE_GRAY, 2},
    {PNG_COLOR_TYPE_GRAY, 4},
    {PNG_COLOR_TYPE_GRAY, 8},
    {PNG_COLOR_TYPE_GRAY, 16},
    {PNG_COLOR_TYPE_RGB, 8},
    {PNG_COLOR_TYPE_RGB, 16},
    {PNG_COLOR_TYPE_PALETTE, 1},
    {PNG_COLOR_TYPE_PALETTE, 2},
    {PNG_COLOR_TYPE_PALETTE, 4},
    {PNG_COLOR_TYPE_PALETTE, 8},
    {PNG_COLOR_TYPE_GRAY_ALPHA, 8},
    {PNG_COLOR_TYPE_GRAY_ALPHA, 16},
    {PNG_COLOR_TYPE_RGB_ALPHA, 8},
    {PNG_COLOR_TYPE_RGB_ALPHA, 16}};

std::size_t channel_count(int color_type) {
    switch (color_type) {
        case PNG_COLOR_TYPE_GRAY_ALPHA:
            return 2;
        case PNG_COLOR_TYPE_RGB:
            return 3;
        case PNG_COLOR_TYPE_RGB_ALPHA:
            return 4;
        default:
            return 1;
    }
}

GreyImage decode(const PngPicture& picture) {
    auto image = decode_mask(png_uri(write_png(picture)));
    EXPECT_TRUE(image) << image.error().message;
    return image ? std::move(*image) : GreyImage();
}

// The one sentence of a refusal.
std::string refusal(const std::string& text, const MaskLimits& limits = {}) {
    const auto image = decode_mask(text, limits);
    return image ? "accepted" : image.error().message;
}

// What the header promises, in floating point and pixel by pixel.
Values expected_values(const PngPicture& picture) {
    const double white = std::pow(2.0, picture.bit_depth) - 1;
    const std::size_t channels = channel_count(picture.color_type);
    Values values;
    for (std::size_t at = 0; at < picture.samples.size(); at += channels) {
        const auto sample = [&picture, at](std::size_t i) { return picture.samples[at + i]; };
        const auto eight_bits = [white, &sample](std::size_t i) {
            return std::floor(sample(i) * 255 / white + 0.5);
        };
        double red = eight_bits(0);
        double green = red;
        double blue = red;
        double alpha = channels % 2 == 0 ? eight_bits(channels - 1) : 255;
        if (channels > 2) {
            green = eight_bits(1);
            blue = eight_bits(2);
        }
        if (picture.color_type == PNG_COLOR_TYPE_PALETTE) {
            const png_color& colour = picture.palette.at(sample(0));
            red = colour.red;
            green = colour.green;
            blue = colour.blue;
            if (sample(0) < picture.palette_alphas.size()) {
                alpha = picture.palette_alphas[sample(0)];
            }
        }
        if (picture.transparent) {
            const png_color_16& colour = *picture.transparent;
            const bool is_it = channels == 1
                                   ? sample(0) == colour.gray
                                   : sample(0) == colour.red && sample(1) == colour.green &&
                                         sample(2) == colour.blue;
            alpha = is_it ? 0 : 255;
        }
        const double luma = 2126 * red + 7152 * green + 722 * blue;
        values.push_back(static_cast<std::uint8_t>(std::floor(luma * alpha / (10'000 * 255) + 0.5))
        );
    }
    return values;
}

PngPicture random_picture(
    const std::pair<int, int>& kind, std::uint32_t width, std::uint32_t height, std::uint64_t seed
) {
    RandomStream random({seed, 0, 0, 40});
    PngPicture picture;
    picture.width = width;
    picture.height = height;
    picture.color_type = kind.first;
    picture.bit_depth = kind.second;
    const std::uint32_t colour_count = 1U << static_cast<unsigned>(kind.second);
    for (std::size_t i = 0; i < channel_count(kind.first) * width * height; ++i) {
        picture.samples.push_back(random.below(colour_count));
    }
    const auto byte = [&random] { return static_cast<png_byte>(random.below(256)); };
    if (kind.first == PNG_COLOR_TYPE_PALETTE) {
        for (std::uint32_t i = 0; i < colour_count; ++i) {
            picture.palette.push_back({byte(), byte(), byte()});
        }
        for (std::uint32_t i = random.below(colour_count + 1); i > 0; --i) {
            picture.palette_alphas.push_back(byte());
        }
    } else if (channel_count(kind.first) % 2 == 1 && random.below(2) == 0) {
        // The colour of the first pixel, so that one at least is transparent.
        const auto sample = [&picture](std::size_t i) {
            return static_cast<png_uint_16>(picture.samples[i % picture.samples.size()]);
        };
        picture.transparent = png_color_16{0, sample(0), sample(1), sample(2), sample(0)};
    }
    return picture;
}

TEST(ImageMask, ReadsEveryKindOfPixelAtEverySmallSizeInterlacedOrNot) {
    std::uint64_t seed = 0;
    for (const auto& kind : kKinds) {
        for (std::uint32_t size = 0; size < 81; ++size) {
            PngPicture picture = random_picture(kind, 1 + size % 9, 1 + size / 9, ++seed);
            const Values expected = expected_values(picture);
            for (const bool is_interlaced : {false, true}) {
                picture.is_interlaced = is_interlaced;
                const GreyImage image = decode(picture);
                EXPECT_EQ(static_cast<std::uint32_t>(image.width), picture.width);
                EXPECT_EQ(static_cast<std::uint32_t>(image.height), picture.height);
                ASSERT_EQ(image.values, expected)
                    << "type " << kind.first << " depth " << kind.second << " seed " << seed
                    << " interlaced " << is_interlaced;
            }
        }
    }
}

TEST(ImageMask, AGreyRampIsReadFromBlackToWhite) {
    EXPECT_EQ(decode({.width = 2, .bit_depth = 1, .samples = {0, 1}}).values, (Values{0, 255}));
    EXPECT_EQ(
        decode({.width = 4, .bit_depth = 2, .samples = {0, 1, 2, 3}}).values,
        (Values{0, 85, 170, 255})
    );
    EXPECT_EQ(
        decode({.width = 2, .height = 2, .bit_depth = 4, .samples = {0, 1, 14, 15}}).values,
        (Values{0, 17, 238, 255})
    );
    PngPicture ramp{.width = 256};
    Values values;
    for (std::uint32_t i = 0; i < 256; ++i) {
        ramp.samples.push_back(i);
        values.push_back(static_cast<std::uint8_t>(i));
    }
    EXPECT_EQ(decode(ramp).values, values);
}

TEST(ImageMask, SixteenBitsAreRoundedToEight) {
    EXPECT_EQ(
        decode({.width = 6, .bit_depth = 16, .samples = {0, 128, 129, 65406, 65407, 65535}}).values,
        (Values{0, 0, 1, 254, 255, 255})
    );
}

TEST(ImageMask, ColoursWeighAsInRec709) {
    const PngPicture picture{
        .width = 4,
        .color_type = PNG_COLOR_TYPE_RGB,
        .samples = {255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255}};
    EXPECT_EQ(decode(picture).values, (Values{54, 182, 18, 255}));
}

TEST(ImageMask, WhatIsTransparentIsBlackInProportion) {
    const PngPicture with_alpha{
        .width = 3,
        .color_type = PNG_COLOR_TYPE_GRAY_ALPHA,
        .samples = {255, 0, 255, 128, 100, 51}};
    EXPECT_EQ(decode(with_alpha).values, (Values{0, 128, 20}));
    const PngPicture with_palette{
        .width = 3,
        .color_type = PNG_COLOR_TYPE_PALETTE,
        .bit_depth = 2,
        .samples = {0, 1, 2},
        .palette = {{255, 255, 255}, {255, 255, 255}, {255, 255, 255}},
        .palette_alphas = {0, 10}};
    EXPECT_EQ(decode(with_palette).values, (Values{0, 10, 255}));
    const PngPicture with_colour{
        .width = 2,
        .bit_depth = 16,
        .samples = {40001, 40000},
        .transparent = png_color_16{0, 0, 0, 0, 40000}};
    EXPECT_EQ(decode(with_colour).values, (Values{156, 0}));
}

TEST(ImageMask, ReadsATextThatIsNotOfThisLibrary) {
    // One white pixel, put together from the specification and zlib.
    const auto image = decode_mask(
        "data:image/png;base64,"
        "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR42mP4DwABAQEAHLCMmQAAAABJRU5ErkJggg"
        "=="
    );
    ASSERT_TRUE(image) << image.error().message;
    EXPECT_EQ(image->width, 1);
    EXPECT_EQ(image->height, 1);
    EXPECT_EQ(image->values, Values{255});
}

TEST(ImageMask, GammaProfilesTextsAndAnimationsChangeNothing) {
    const std::string png = write_png({.width = 2, .samples = {100, 200}});
    const std::vector<std::pair<std::string, std::string>> chunks = {
        {"gAMA", big_endian(100'000)},
        {"gAMA", big_endian(0)},
        {"sRGB", "\7"},
        {"cHRM", std::string(32, '\xFF')},
        {"iCCP", "broken"},
        {"sBIT", "\1"},
        {"bKGD", "?"},
        {"zTXt", std::string("key\0\0no zlib", 12)},
        {"iTXt", std::string(100'000, 'x')},
        {"eXIf", "MM"},
        {"acTL", std::string(8, '\1')},
        {"prVt", std::string(500'000, '\0')}};
    for (const auto& [name, data] : chunks) {
        const auto image = decode_mask(png_uri(with_chunk(png, name, data)));
        ASSERT_TRUE(image) << name << ": " << image.error().message;
        EXPECT_EQ(image->values, (Values{100, 200})) << name;
    }
    std::string many = png;
    for (int i = 0; i < 20'000; ++i) {
        many.insert(
            modelsynth::testing::kAfterHeader,
            big_endian(0) + "prVt" + modelsynth::testing::checksum("prVt")
        );
    }
    EXPECT_EQ(refusal(png_uri(many)), "accepted");
}

TEST(ImageMask, LimitsHoldAtTheirEdge) {
    const auto of_size = [](std::uint32_t width, std::uint32_t height) {
        return png_uri(write_png(
            {.width = width,
             .height = height,
             .samples = std::vector<std::uint32_t>(std::size_t{width} * height)}
        ));
    };
    EXPECT_EQ(refusal(of_size(1024, 1)), "accepted");
    EXPECT_EQ(refusal(of_size(1, 1024)), "accepted");
    EXPECT_EQ(refusal(of_size(1025, 1)), "the image is 1025 pixels wide; the limit is 1024");
    EXPECT_EQ(refusal(of_size(1, 5000)), "the image is 5000 pixels high; the limit is 1024");
    EXPECT_EQ(decode_mask(of_size(1025, 1)).error().code, ErrorCode::kTooLarge);

    const std::string text = of_size(3, 2);
    MaskLimits limits;
    limits.side_pixels_max = 3;
    limits.text_bytes_max = text.size();
    EXPECT_EQ(refusal(text, limits), "accepted");
    limits.side_pixels_max = 2;
    EXPECT_EQ(refusal(text, limits), "the image is 3 pixels wide; the limit is 2");
    limits.text_bytes_max = text.size() - 1;
    EXPECT_EQ(
        refusal(text, limits),
        "the image's text is " + std::to_string(text.size()) + " bytes long; the limit is " +
            std::to_string(text.size() - 1)
    );
    EXPECT_EQ(decode_mask(text, limits).error().code, ErrorCode::kTooLarge);
    // Not even looked at.
    const std::string long_text(MaskLimits().text_bytes_max + 1, 'x');
    EXPECT_EQ(decode_mask(long_text).error().code, ErrorCode::kTooLarge);
    EXPECT_EQ(decode_mask(long_text.substr(1)).error().code, ErrorCode::kInvalidArgument);
}

TEST(ImageMask, AShortTextMayHoldTheLargestImage) {
    for (const bool is_interlaced : {false, true}) {
        const std::string text = png_uri(write_png(
            {.width = 1024,
             .height = 1024,
             .bit_depth = 1,
             .is_interlaced = is_interlaced,
             .samples = std::vector<std::uint32_t>(1024 * 1024, 1)}
        ));
        EXPECT_LT(text.size(), 20'000U);
        const auto image = decode_mask(text);
        ASSERT_TRUE(image) << image.error().message;
        EXPECT_EQ(image->values, Values(1024 * 1024, 255));
    }
}

TEST(ImageMask, ASizeThatIsOnlyClaimedIsRefusedBeforeAnythingIsMade) {
    const std::string png = write_png({.samples = {1}});
    const auto claiming = [&png](std::size_t width, std::size_t height) {
        std::string claim = png;
        claim.replace(16, 8, big_endian(width) + big_endian(height));
        return refusal(png_uri(with_true_checksums(claim)));
    };
    EXPECT_EQ(claiming(0xFFFFFFFF, 1), "the image is 4294967295 pixels wide; the limit is 1024");
    EXPECT_EQ(claiming(1, 0x7FFFFFFF), "the image is 2147483647 pixels high; the limit is 1024");
    EXPECT_EQ(claiming(0, 1), "the image is 0 pixels wide");
    EXPECT_EQ(claiming(1, 0), "the image is 0 pixels high");
    EXPECT_EQ(claiming(1, 2), "the PNG is broken: Not enough image data");
    EXPECT_EQ(claiming(1024, 1024), "the PNG is broken: Not enough image data");
}

TEST(ImageMask, NamesWhatIsWrong) {
    const std::string kNoUri = "not a data: URI of a PNG, which begins with data:image/png;base64,";
    for (const char* text :
         {"",
          "castle",
          "data:",
          "data:image/jpeg;base64,AAAA",
          "data:image/png,AAAA",
          "data:image/png;base64",
          "https://example.org/mask.png"}) {
        EXPECT_EQ(refusal(text), kNoUri);
    }
    EXPECT_EQ(refusal("data:image/png;base64,"), "the PNG is cut off");
    EXPECT_EQ(refusal("data:image/png;base64,iVB"), "the base64 is cut off");
    EXPECT_EQ(refusal("data:image/png;base64,iVBO Rw0"), "the base64 is broken at character 26");
    EXPECT_EQ(refusal("data:image/png;base64,iVBO"), "the PNG is cut off");
    EXPECT_EQ(refusal(png_uri("GIF89a")), "the bytes are not a PNG");

    const std::string png = write_png({.samples = {1}});
    EXPECT_EQ(refusal(png_uri(png + "abc")), "the PNG has 3 bytes after its end");
    EXPECT_EQ(
        refusal(png_uri(write_png(
            {.width = 2,
             .color_type = PNG_COLOR_TYPE_PALETTE,
             .bit_depth = 4,
             .samples = {0, 3},
             .palette = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}}}
        ))),
        "the PNG is broken: a pixel has a colour that is not in the palette"
    );
    EXPECT_EQ(
        refusal(png_uri(with_chunk(png, "CgBI", "data"))),
        "the PNG is broken: CgBI: unhandled critical chunk"
    );
}

// Small, and each with other parts of the format.
std::vector<std::string> small_files() {
    std::vector<std::string> files;
    std::uint64_t seed = 100;
    for (const auto& kind : kKinds) {
        PngPicture picture = random_picture(kind, 5, 3, ++seed);
        picture.is_interlaced = seed % 2 == 0;
        files.push_back(with_chunk(write_png(picture), "tEXt", std::string("a\0b", 3)));
    }
    return files;
}

TEST(ImageMask, AFileThatEndsTooEarlyIsSaidToBeCutOff) {
    for (const std::string& png : small_files()) {
        for (std::size_t length = 0; length < png.size(); ++length) {
            EXPECT_EQ(refusal(png_uri(png.substr(0, length))), "the PNG is cut off") << length;
        }
        const std::string text = png_uri(png);
        EXPECT_EQ(refusal(text), "accepted");
        for (std::size_t length = 0; length < text.size(); ++length) {
            EXPECT_NE(refusal(text.substr(0, length)), "accepted") << length;
        }
    }
}

TEST(ImageMask, NoFlippedBitGoesUnnoticed) {
    for (const std::string& png : small_files()) {
        for (std::size_t at = 0; at < png.size(); ++at) {
            for (const int mask : {1, 2, 4, 8, 16, 32, 64, 128, 255}) {
                std::string changed = png;
                changed[at] = static_cast<char>(changed[at] ^ mask);
                EXPECT_NE(refusal(png_uri(changed)), "accepted") << at << " ^ " << mask;
                // Behind true checksums it may be another picture, or none; never a crash.
                EXPECT_NE(refusal(png_uri(with_true_checksums(changed))), "");
            }
        }
    }
}

TEST(ImageMask, NoChangedCharacterOfTheTextIsReadOutOfBounds) {
    const std::string text = png_uri(small_files().front());
    for (std::size_t at = 0; at < text.size(); ++at) {
        for (int character = 0; character < 256; ++character) {
            std::string changed = text;
            changed[at] = static_cast<char>(character);
            EXPECT_NE(refusal(changed), "");
        }
    }
}

}  // namespace
}  // namespace modelsynth::proto
