// A mask of a constraint: a data: URI of a PNG. The input is the file, its checksums made true.

#include "proto/image_mask.h"
#include "tests/fuzz/targets/law.h"
#include "tests/support/png_file.h"

#include <cstddef>
#include <cstdint>
#include <string>

using namespace modelsynth;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string file(reinterpret_cast<const char*>(data), size);
    const auto image = proto::decode_mask(
        modelsynth::testing::png_uri(modelsynth::testing::with_true_checksums(file))
    );
    if (image) {
        law(image->width > 0 && image->height > 0);
        law(image->values.size() ==
            static_cast<std::size_t>(image->width) * static_cast<std::size_t>(image->height));
    } else {
        law(!image.error().message.empty());
    }
    return 0;
}
