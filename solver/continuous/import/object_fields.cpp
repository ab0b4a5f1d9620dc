#include "solver/continuous/import/object_fields.h"

#include <array>

namespace modelsynth::continuous {

namespace {

// By their names in JSON examples.
constexpr std::array<std::string_view, 3> kObjectFields = {"weight", "shape", "decorations"};

}  // namespace

std::vector<SaidField> said_fields(
    const SharedExtra& extras, std::span<const std::string_view> names, const Source& place
) {
    std::vector<SaidField> said;
    for (const std::string_view name : names) {
        if (const Extra* value = extras->find(name)) {
            const std::string member = "/" + std::string(name);
            said.push_back(
                {{place.in_example + member, place.in_file + member, place.who},
                 SharedExtra(extras, value)}
            );
        }
    }
    return said;
}

void ObjectFields::read(ObjectId object, const SharedExtra& extras, Source place, ByField& fields) {
    place.in_example = "/objects/" + std::to_string(object - 1);
    for (SaidField& said : said_fields(extras, kObjectFields, place)) {
        const auto [first, is_new] = fields.emplace(said.source.in_example, said);
        const SharedExtra& before = first->second.value;
        if (!is_new && before != said.value && *before != *said.value) {
            refuse_(said.source, " says otherwise than " + first->second.source.who);
        }
    }
}

std::vector<SaidField> ObjectFields::fields() const {
    ByField all = of_nodes_;
    all.insert(of_materials_.begin(), of_materials_.end());
    std::vector<SaidField> said;
    for (auto& [place, field] : all) {
        said.push_back(std::move(field));
    }
    return said;
}

}  // namespace modelsynth::continuous
