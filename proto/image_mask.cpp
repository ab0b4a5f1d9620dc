// libpng's plain interface is used and not its simplified one: the latter takes no limits, converts
// by gamma, and is where most of the library's faults of late were.
//
// libpng leaves by longjmp on an error, which must not skip a destructor. So PngReader::run() alone
// calls setjmp; what runs below it are the functions that take a png_structp, and they hold only
// numbers and pointers. All memory belongs to the frames above it.

#include "proto/image_mask.h"

#include "proto/base64.h"

#include <png.h>

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstddef>
#include <cstring>
#include <new>
#include <span>
#include <string>
#include <type_traits>
#include <utility>

namespace modelsynth::proto {

namespace {

using Bytes = std::span<const std::byte>;

constexpr std::string_view kUriStart = "data:image/png;base64,";
// The signature, then the length and the name of the first chunk; width and height follow.
constexpr std::string_view kPngStart("\x89PNG\r\n\x1A\n\0\0\0\rIHDR", 16);
constexpr std::size_t kPngStartBytes = kPngStart.size() + 8;

tl::unexpected<Error> invalid(std::string message) {
    return tl::unexpected(Error{ErrorCode::kInvalidArgument, std::move(message)});
}

tl::unexpected<Error> too_large(std::string message) {
    return tl::unexpected(Error{ErrorCode::kTooLarge, std::move(message)});
}

Result<std::vector<std::byte>> bytes_of(std::string_view text, const MaskLimits& limits) {
    if (text.size() > limits.text_bytes_max) {
        return too_large(
            "the image's text is " + std::to_string(text.size()) + " bytes long; the limit is " +
            std::to_string(limits.text_bytes_max)
        );
    }
    if (!text.starts_with(kUriStart)) {
        return invalid("not a data: URI of a PNG, which begins with " + std::string(kUriStart));
    }
    auto bytes = decode_base64(text.substr(kUriStart.size()));
    if (bytes) {
        return std::move(*bytes);
    }
    const std::size_t at = kUriStart.size() + bytes.error();
    return invalid(
        at == text.size() ? "the base64 is cut off"
                          : "the base64 is broken at character " + std::to_string(at)
    );
}

// Requires: as many bytes are there.
std::uint32_t big_endian(Bytes bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (const std::byte byte : bytes.subspan(at, 4)) {
        value = value << 8U | std::to_integer<std::uint32_t>(byte);
    }
    return value;
}

// Whether the file is a PNG and how large it says to be, so that the error names the number.
Result<void> check_start(Bytes bytes, const MaskLimits& limits) {
    const std::string_view start(
        reinterpret_cast<const char*>(bytes.data()), std::min(bytes.size(), kPngStart.size())
    );
    if (!kPngStart.starts_with(start)) {
        return invalid("the bytes are not a PNG");
    }
    if (bytes.size() < kPngStartBytes) {
        return invalid("the PNG is cut off");
    }
    for (const std::size_t side : {std::size_t{0}, std::size_t{1}}) {
        const std::uint32_t pixels = big_endian(bytes, kPngStart.size() + 4 * side);
        const std::string size =
            std::to_string(pixels) + (side == 0 ? " pixels wide" : " pixels high");
        if (pixels == 0) {
            return invalid("the image is " + size);
        }
        if (pixels > static_cast<std::uint32_t>(limits.side_pixels_max)) {
            return too_large(
                "the image is " + size + "; the limit is " + std::to_string(limits.side_pixels_max)
            );
        }
    }
    return {};
}

struct Colour {
    std::uint32_t red;
    std::uint32_t green;
    std::uint32_t blue;
    std::uint32_t alpha = 255;
};

// Over black, and rounded once.
std::uint8_t grey_of(const Colour& colour) {
    constexpr std::uint32_t kWhite = 10'000 * 255;
    const std::uint32_t luma = 2126 * colour.red + 7152 * colour.green + 722 * colour.blue;
    return static_cast<std::uint8_t>((luma * colour.alpha + kWhite / 2) / kWhite);
}

// What libpng's callbacks share.
struct Input {
    Bytes left;
    bool is_cut_off = false;
    std::array<char, 160> message = {};
};

extern "C" {
void take_bytes(png_structp png, png_bytep target, std::size_t count) {
    auto& input = *static_cast<Input*>(png_get_io_ptr(png));
    if (count > input.left.size()) {
        input.is_cut_off = true;
        png_error(png, "cut off");
    }
    std::memcpy(target, input.left.data(), count);
    input.left = input.left.subspan(count);
}

[[noreturn]] void leave(png_structp png, png_const_charp message) {
    auto& input = *static_cast<Input*>(png_get_error_ptr(png));
    std::strncpy(input.message.data(), message, input.message.size() - 1);
    png_longjmp(png, 1);
}

void ignore_warning(png_structp /*png*/, png_const_charp /*message*/) {}
}

// One reading of one file.
class PngReader {
  public:
    explicit PngReader(Bytes bytes) : input_{bytes} {
        png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, &input_, leave, ignore_warning);
        info_ = png_ == nullptr ? nullptr : png_create_info_struct(png_);
        if (info_ == nullptr) {
            png_destroy_read_struct(&png_, &info_, nullptr);
            throw std::bad_alloc();
        }
        png_set_read_fn(png_, &input_, take_bytes);
    }

    ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }

    PngReader(const PngReader&) = delete;
    PngReader& operator=(const PngReader&) = delete;

    // Takes a step, step(png, info); false when libpng left it, and error() tells why.
    // Requires: neither the step nor anything it calls has a destructor to skip.
    template <class Step>
    [[nodiscard]] bool run(const Step& step) {
        static_assert(std::is_trivially_destructible_v<Step>);
        if (setjmp(png_jmpbuf(png_)) != 0) {
            return false;
        }
        step(png_, info_);
        return true;
    }

    [[nodiscard]] tl::unexpected<Error> error() const {
        return invalid(
            input_.is_cut_off ? "the PNG is cut off"
                              : "the PNG is broken: " + std::string(input_.message.data())
        );
    }

    [[nodiscard]] std::size_t bytes_left() const { return input_.left.size(); }

  private:
    Input input_;
    png_structp png_ = nullptr;
    png_infop info_ = nullptr;
};

// What libpng's rows hold.
struct Layout {
    png_uint_32 width = 0;
    png_uint_32 height = 0;
    std::size_t row_bytes = 0;
    bool is_interlaced = false;
    png_byte channel_count = 0;                 // 1 shade, 2 grey and alpha, 3 RGB, 4 RGBA
    std::array<std::uint8_t, 256> shades = {};  // of the bytes of a row of 1 channel
    std::size_t shade_count = 0;
};

void set_limits(png_structp png, const MaskLimits& limits) {
    const auto side_max = static_cast<png_uint_32>(limits.side_pixels_max);
    png_set_user_limits(png, side_max, side_max);
    // No chunk that is all there is longer than the text.
    png_set_chunk_malloc_max(png, limits.text_bytes_max);
    png_set_chunk_cache_max(png, 1);  // keeps none; 0 would be as many as there are
    // Only the header, the palette, its transparency and the pixels are parsed.
    png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
    // What could be passed over with a warning is an error: the mask would be another.
    png_set_benign_errors(png, 0);
    png_set_crc_action(png, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
}

void read_palette(png_structp png, png_infop info, Layout& layout) {
    png_colorp colours = nullptr;
    int colour_count = 0;
    png_get_PLTE(png, info, &colours, &colour_count);
    png_bytep alphas = nullptr;
    int alpha_count = 0;
    png_get_tRNS(png, info, &alphas, &alpha_count, nullptr);
    layout.shade_count = std::min(static_cast<std::size_t>(colour_count), layout.shades.size());
    for (std::size_t i = 0; i < layout.shade_count; ++i) {
        const bool has_alpha = i < static_cast<std::size_t>(alpha_count);
        layout.shades[i] = grey_of(
            {colours[i].red, colours[i].green, colours[i].blue, has_alpha ? alphas[i] : 255U}
        );
    }
}

// Asks for bytes, one for each sample or palette index.
void read_header(png_structp png, png_infop info, Layout& layout) {
    png_read_info(png, info);
    layout.width = png_get_image_width(png, info);
    layout.height = png_get_image_height(png, info);
    layout.is_interlaced = png_get_interlace_type(png, info) == PNG_INTERLACE_ADAM7;
    if (png_get_color_type(png, info) == PNG_COLOR_TYPE_PALETTE) {
        read_palette(png, info, layout);
        png_set_packing(png);
    } else {
        for (std::size_t i = 0; i < layout.shades.size(); ++i) {
            layout.shades[i] = static_cast<std::uint8_t>(i);
        }
        layout.shade_count = layout.shades.size();
        png_set_expand(png);  // to 8 bits at least, and a transparent colour to alpha
        png_set_scale_16(png);
    }
    png_read_update_info(png, info);
    layout.channel_count = png_get_channels(png, info);
    layout.row_bytes = png_get_rowbytes(png, info);
}

std::uint8_t grey_at(png_structp png, const Layout& layout, png_const_bytep pixel) {
    switch (layout.channel_count) {
        case 1:
            if (pixel[0] >= layout.shade_count) {
                png_error(png, "a pixel has a colour that is not in the palette");
            }
            return layout.shades[pixel[0]];
        case 2:
            return grey_of({pixel[0], pixel[0], pixel[0], pixel[1]});
        case 3:
            return grey_of({pixel[0], pixel[1], pixel[2]});
        default:
            return grey_of({pixel[0], pixel[1], pixel[2], pixel[3]});
    }
}

// The pixels of one pass over an image.
struct Pass {
    png_uint_32 row_first;
    png_uint_32 row_step;
    png_uint_32 column_first;
    png_uint_32 column_step;
};

constexpr std::array<Pass, 1> kPlain = {{{0, 1, 0, 1}}};
// PNG specification, section 8.2.
constexpr std::array<Pass, 7> kAdam7 = {
    {{0, 8, 0, 8},
     {0, 8, 4, 8},
     {4, 8, 0, 4},
     {0, 4, 2, 4},
     {2, 4, 0, 2},
     {0, 2, 1, 2},
     {1, 2, 0, 1}}};

// Puts the passes of an interlaced image together by itself, since libpng would need the whole
// image in its own format for it, up to four times the memory.
void read_pixels(png_structp png, const Layout& layout, png_bytep row, std::uint8_t* values) {
    const auto passes =
        layout.is_interlaced ? std::span<const Pass>(kAdam7) : std::span<const Pass>(kPlain);
    for (const Pass& pass : passes) {
        if (pass.column_first >= layout.width) {
            continue;  // libpng leaves empty passes out too
        }
        for (png_uint_32 y = pass.row_first; y < layout.height; y += pass.row_step) {
            png_read_row(png, row, nullptr);
            png_const_bytep pixel = row;
            for (png_uint_32 x = pass.column_first; x < layout.width; x += pass.column_step) {
                values[std::size_t{y} * layout.width + x] = grey_at(png, layout, pixel);
                pixel += layout.channel_count;
            }
        }
    }
    png_read_end(png, nullptr);
}

Result<GreyImage> decode_png(Bytes bytes, const MaskLimits& limits) {
    PngReader reader(bytes);
    Layout layout;
    const auto header = [&limits, &layout](png_structp png, png_infop info) {
        set_limits(png, limits);
        read_header(png, info, layout);
    };
    if (!reader.run(header)) {
        return reader.error();
    }
    GreyImage image;
    image.width = static_cast<std::int32_t>(layout.width);
    image.height = static_cast<std::int32_t>(layout.height);
    image.values.resize(std::size_t{layout.width} * layout.height);
    std::vector<png_byte> row(layout.row_bytes);
    const auto pixels = [&layout, &row, &image](png_structp png, png_infop /*info*/) {
        read_pixels(png, layout, row.data(), image.values.data());
    };
    if (!reader.run(pixels)) {
        return reader.error();
    }
    if (reader.bytes_left() > 0) {
        return invalid(
            "the PNG has " + std::to_string(reader.bytes_left()) + " bytes after its end"
        );
    }
    return image;
}

}  // namespace

Result<GreyImage> decode_mask(std::string_view text, const MaskLimits& limits) {
    const auto bytes = bytes_of(text, limits);
    if (!bytes) {
        return tl::unexpected(bytes.error());
    }
    if (const auto start = check_start(*bytes, limits); !start) {
        return tl::unexpected(start.error());
    }
    return decode_png(*bytes, limits);
}

}  // namespace modelsynth::proto
