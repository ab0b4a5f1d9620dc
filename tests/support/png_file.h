#pragma once

#include <openssl/evp.h>
#include <png.h>
#include <zlib.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace modelsynth::testing {

// What a PNG is to hold; libpng's names of the colour types.
struct PngPicture {
    std::uint32_t width = 1;
    std::uint32_t height = 1;
    int color_type = PNG_COLOR_TYPE_GRAY;
    int bit_depth = 8;
    bool is_interlaced = false;
    std::vector<std::uint32_t> samples = {};  // row by row, channels together
    std::vector<png_color> palette = {};
    std::vector<png_byte> palette_alphas = {};
    std::optional<png_color_16> transparent = {};
};

// The picture as a file, written by libpng. Ends the program when libpng cannot.
inline std::string write_png(const PngPicture& picture) {
    std::string file;
    const auto fail = [](png_structp, png_const_charp) { std::abort(); };
    const auto append = [](png_structp png, png_bytep bytes, std::size_t count) {
        static_cast<std::string*>(png_get_io_ptr(png))
            ->append(reinterpret_cast<const char*>(bytes), count);
    };
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, fail, nullptr);
    png_infop info = png_create_info_struct(png);
    png_set_write_fn(png, &file, append, nullptr);
    png_set_check_for_invalid_index(png, 0);
    png_set_IHDR(
        png,
        info,
        picture.width,
        picture.height,
        picture.bit_depth,
        picture.color_type,
        picture.is_interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE,
        PNG_COMPRESSION_TYPE_DEFAULT,
        PNG_FILTER_TYPE_DEFAULT
    );
    if (!picture.palette.empty()) {
        png_set_PLTE(png, info, picture.palette.data(), static_cast<int>(picture.palette.size()));
    }
    if (!picture.palette_alphas.empty() || picture.transparent) {
        png_set_tRNS(
            png,
            info,
            picture.palette_alphas.data(),
            static_cast<int>(picture.palette_alphas.size()),
            picture.transparent ? &*picture.transparent : nullptr
        );
    }
    png_write_info(png, info);
    const std::size_t row_samples = picture.samples.size() / picture.height;
    const auto depth = static_cast<std::size_t>(picture.bit_depth);
    const std::size_t row_bytes = (row_samples * depth + 7) / 8;
    std::vector<png_byte> bytes(row_bytes * picture.height);
    std::vector<png_bytep> rows;
    for (std::size_t y = 0; y < picture.height; ++y) {
        rows.push_back(bytes.data() + y * row_bytes);
        for (std::size_t bit = 0; bit < row_samples * depth; ++bit) {
            const std::uint32_t sample = picture.samples[y * row_samples + bit / depth];
            const std::uint32_t is_set = sample >> (depth - 1 - bit % depth) & 1U;
            rows.back()[bit / 8] |= static_cast<png_byte>(is_set << (7 - bit % 8));
        }
    }
    png_write_image(png, rows.data());
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    return file;
}

inline std::string encode_base64(std::string_view bytes) {
    std::string text((bytes.size() + 2) / 3 * 4 + 1, '\0');
    const int length = EVP_EncodeBlock(
        reinterpret_cast<unsigned char*>(text.data()),
        reinterpret_cast<const unsigned char*>(bytes.data()),
        static_cast<int>(bytes.size())
    );
    text.resize(static_cast<std::size_t>(length));
    return text;
}

// The text of a mask.
inline std::string png_uri(std::string_view png) {
    return "data:image/png;base64," + encode_base64(png);
}

inline std::string big_endian(std::size_t value) {
    std::string bytes;
    for (const unsigned shift : {24U, 16U, 8U, 0U}) {
        bytes += static_cast<char>(value >> shift & 0xFFU);
    }
    return bytes;
}

// The checksum of a chunk, as it stands after its name and its data.
inline std::string checksum(std::string_view name_and_data) {
    return big_endian(crc32(
        0,
        reinterpret_cast<const Bytef*>(name_and_data.data()),
        static_cast<uInt>(name_and_data.size())
    ));
}

constexpr std::size_t kAfterHeader = 8 + 12 + 13;  // where the second chunk of a PNG begins

// The file with one more chunk behind the header.
inline std::string with_chunk(std::string png, const std::string& name, const std::string& data) {
    png.insert(kAfterHeader, big_endian(data.size()) + name + data + checksum(name + data));
    return png;
}

// The file with the checksums that fit its chunks, as far as there are whole ones.
inline std::string with_true_checksums(std::string png) {
    for (std::size_t at = 8; at + 12 <= png.size();) {
        std::size_t length = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            length = length << 8U | static_cast<unsigned char>(png[at + i]);
        }
        if (length > png.size() - at - 12) {
            break;
        }
        png.replace(at + 8 + length, 4, checksum(std::string_view(png).substr(at + 4, 4 + length)));
        at += 12 + length;
    }
    return png;
}

}  // namespace modelsynth::testing
