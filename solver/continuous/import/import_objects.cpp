#include "solver/continuous/import/import_objects.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <variant>

namespace modelsynth::continuous {

namespace {

constexpr std::size_t kObjectNameBytesMax = 64;

// Programs number the names of copies.
bool look_alike(const Material& a, const Material& b) {
    return a.base_color == b.base_color && a.metallic == b.metallic && a.roughness == b.roughness &&
           a.emissive == b.emissive && a.double_sided == b.double_sided && a.texture == b.texture;
}

Error refusal(ErrorCode code, std::string_view name, const std::string& why) {
    return {code, "object " + quoted(name) + " " + why};
}

}  // namespace

std::string_view object_name(const GlbNode& node, const Kit& kit, const Primitive& primitive) {
    const Extra* extra = node.extras.find("object");
    const auto* name = extra == nullptr ? nullptr : std::get_if<std::string>(&extra->value);
    if (name != nullptr && !name->empty()) {
        return *name;
    }
    const std::string& of_material = kit.materials[primitive.material].name;
    return of_material.empty() ? std::string_view("object") : of_material;
}

Result<ObjectId> ImportObjects::number_of(std::string_view name, const Material& material) {
    const auto found = std::find_if(types_.begin(), types_.end(), [&](const ObjectType& type) {
        return type.name == name;
    });
    if (found != types_.end()) {
        const Material& first = materials_[found->material];
        if (!look_alike(first, material)) {
            return tl::unexpected(refusal(
                ErrorCode::kInvalidArgument,
                name,
                "has material " + quoted(material.name) + " here and another one, " +
                    quoted(first.name) + ", before"
            ));
        }
        return static_cast<ObjectId>(found - types_.begin() + 1);
    }
    if (name.size() > kObjectNameBytesMax) {
        return tl::unexpected(refusal(ErrorCode::kTooLarge, name, "has too long a name"));
    }
    if (types_.size() == kObjectTypesMax) {
        return tl::unexpected(refusal(
            ErrorCode::kTooLarge, name, "is one more than " + std::to_string(kObjectTypesMax)
        ));
    }
    const auto same = std::find(materials_.begin(), materials_.end(), material);
    const auto number = static_cast<std::uint32_t>(same - materials_.begin());
    if (same == materials_.end()) {
        materials_.push_back(material);
    }
    types_.push_back({std::string(name), number});
    return static_cast<ObjectId>(types_.size());
}

std::string shortened(std::string_view name) {
    if (name.size() <= kObjectNameBytesMax) {
        return std::string(name);
    }
    std::size_t end = kObjectNameBytesMax;
    while (end > 0 && (static_cast<unsigned char>(name[end]) & 0xC0) == 0x80) {
        --end;  // within a character
    }
    return std::string(name.substr(0, end)) + "...";
}

std::string quoted(std::string_view name) { return "\"" + shortened(name) + "\""; }

}  // namespace modelsynth::continuous
