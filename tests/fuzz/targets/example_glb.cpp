// The body of POST /v1/examples as a binary glTF file, and such a file as a discrete example's
// meshes.

#include "proto/example_codec.h"
#include "solver/mesh/glb_reader.h"
#include "tests/fuzz/targets/law.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace proto = modelsynth::proto;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto parsed = proto::parse_example_glb({reinterpret_cast<const char*>(data), size}, {});
    if (parsed) {
        law(proto::parse_example(parsed->canonical, {}).has_value());
    } else {
        law(!proto::to_json(parsed.error()).empty());
    }
    const auto kit = modelsynth::read_glb(std::as_bytes(std::span(data, size)));
    for (std::size_t i = 0; kit && i < kit->meshes.size(); ++i) {
        for (const modelsynth::Primitive& primitive : kit->meshes[i].primitives) {
            law(primitive.material < kit->materials.size());
            for (const std::uint32_t index : primitive.indices) {
                law(index < primitive.positions.size());
            }
        }
    }
    return 0;
}
