#include "clients/cli/input_file.h"

#include <nlohmann/json.hpp>
#include <openssl/evp.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string_view>
#include <utility>

namespace modelsynth::cli {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// Larger inputs are refused here rather than sent; servers take far less.
constexpr std::size_t kInputBytesMax = std::size_t{512} << 20;

struct CloseFile {
    void operator()(std::FILE* file) const {
        if (file != stdin) {
            std::fclose(file);
        }
    }
};

std::string encode_base64(std::string_view bytes) {
    std::string text((bytes.size() + 2) / 3 * 4 + 1, '\0');  // the encoder adds a zero
    const int length = EVP_EncodeBlock(
        reinterpret_cast<unsigned char*>(text.data()),
        reinterpret_cast<const unsigned char*>(bytes.data()),
        static_cast<int>(bytes.size())
    );
    text.resize(static_cast<std::size_t>(length));
    return text;
}

}  // namespace

Outcome<std::string> read_input(const std::string& path) {
    const auto refuse = [&path](const std::string& why) {
        return wrong_usage("cannot read " + path + ": " + why);
    };
    std::error_code error;
    if (path != "-" && fs::is_directory(path, error)) {
        return refuse("it is a folder");
    }
    const std::unique_ptr<std::FILE, CloseFile> file(
        path == "-" ? stdin : std::fopen(path.c_str(), "rb")
    );
    if (!file) {
        return refuse(std::strerror(errno));
    }
    std::string bytes;
    std::array<char, 65536> piece;
    while (const std::size_t count = std::fread(piece.data(), 1, piece.size(), file.get())) {
        bytes.append(piece.data(), count);
        if (bytes.size() > kInputBytesMax) {
            return refuse("it is too large");
        }
    }
    if (std::ferror(file.get()) != 0) {
        return refuse(std::strerror(errno));
    }
    return bytes;
}

Outcome<std::string> read_example_file(const std::string& path) {
    auto text = read_input(path);
    if (!text) {
        return text;
    }
    Json example = Json::parse(*text, nullptr, false);
    if (example.is_discarded()) {
        return wrong_usage(path + " is not JSON");
    }
    if (!example.is_object() || !example.contains("meshes") || !example["meshes"].is_string()) {
        return text;
    }
    const auto meshes = example["meshes"].get<std::string>();
    if (meshes.starts_with("data:")) {
        return text;
    }
    // Only beside the example: files come from others too, and what they name is sent away.
    if (!meshes.ends_with(".glb") || fs::path(meshes).has_parent_path()) {
        return wrong_usage(
            path + ": meshes must be a data: URI or the name of a .glb file beside it"
        );
    }
    return read_input((fs::path(path).parent_path() / meshes).string())
        .map([&example](const std::string& glb) {
            example["meshes"] = "data:model/gltf-binary;base64," + encode_base64(glb);
            return example.dump(-1, ' ', false, Json::error_handler_t::replace);
        });
}

}  // namespace modelsynth::cli
