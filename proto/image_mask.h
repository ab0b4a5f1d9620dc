#pragma once

#include "proto/limits.h"
#include "solver/core/result.h"

#include <cstdint>
#include <string_view>
#include <vector>

namespace modelsynth::proto {

// A picture in shades of grey.
// Shape: values.size() == width * height, row by row from the top; 0 is black, 255 is white.
struct GreyImage {
    std::int32_t width = 0;
    std::int32_t height = 0;
    std::vector<std::uint8_t> values;
};

// The image of a mask: the text `data:image/png;base64,` and a PNG, of any colour type and bit
// depth, interlaced or not.
//
// A pixel's value is the Rec. 709 luma (0.2126 R + 0.7152 G + 0.0722 B) of the samples as they are
// stored, in proportion to alpha: what is transparent is black. Samples of 16 bits are rounded to 8
// first. What the file says of gamma and colour profiles changes nothing, so that equal samples are
// equal masks; of an animation the still image is taken.
//
// Fails: kTooLarge past a limit; kInvalidArgument for anything else that is wrong, even where it
//        could be guessed around: a false checksum anywhere, a colour that the palette does not
//        have, bytes after the end. The message is one sentence; a place in the text counts from 0.
// Hostile input is expected: the limits hold before any pixel is unpacked.
// Cost:  O(pixels) time; width * height bytes and the PNG's own, and a few rows beside them.
[[nodiscard]] Result<GreyImage> decode_mask(std::string_view text, const MaskLimits& limits = {});

}  // namespace modelsynth::proto
