#include "solver/examples/example_builder.h"

#include "solver/core/result.h"

#include <array>
#include <utility>

namespace modelsynth::examples {

namespace {

void require(bool condition, const std::string& why) { check(condition, why.c_str()); }

}  // namespace

ExampleBuilder::ExampleBuilder(std::string name, double width_m, double height_m, double depth_m) {
    example_.name = std::move(name);
    example_.cell = {width_m, height_m, depth_m};
    // Layouts are drawn with the shares that the models should have.
    example_.default_weights = discrete::WeightRule::kExample;
}

MaterialId ExampleBuilder::add_material(Material material) {
    kit_.materials.push_back(std::move(material));
    return static_cast<MaterialId>(kit_.materials.size() - 1);
}

void ExampleBuilder::add_label(char letter, discrete::Piece piece) {
    const auto label = static_cast<Label>(example_.pieces.size());
    require(
        label_of_.emplace(letter, label).second,
        std::string("two pieces of an example have the letter ") + letter
    );
    example_.pieces.push_back(std::move(piece));
}

void ExampleBuilder::add_empty(char letter, const std::string& name) {
    example_.empty = static_cast<Label>(example_.pieces.size());
    add_label(letter, {name, std::nullopt, 0, 1});
}

void ExampleBuilder::add_undrawn(char letter, const std::string& name, double weight) {
    add_label(letter, {name, std::nullopt, 0, weight});
}

void ExampleBuilder::add_piece(
    char letter, const std::string& name, MeshBuilder mesh, double weight
) {
    const auto index = static_cast<std::uint32_t>(kit_.meshes.size());
    kit_.meshes.push_back(std::move(mesh).build(name));
    add_label(letter, {name, index, 0, weight});
}

void ExampleBuilder::add_turned(
    std::string_view letters, const std::string& name, MeshBuilder mesh, double weight
) {
    static constexpr std::array<const char*, 4> kSuffixes = {"_e", "_n", "_w", "_s"};
    require(letters.size() == 4, "a turned piece needs four letters: " + name);
    const auto index = static_cast<std::uint32_t>(kit_.meshes.size());
    kit_.meshes.push_back(std::move(mesh).build(name));
    for (std::uint8_t turns = 0; turns < 4; ++turns) {
        add_label(letters[turns], {name + kSuffixes[turns], index, turns, weight});
    }
}

void ExampleBuilder::add_axial(
    std::string_view letters, const std::string& name, MeshBuilder mesh, double weight
) {
    require(letters.size() == 2, "an axial piece needs two letters: " + name);
    const auto index = static_cast<std::uint32_t>(kit_.meshes.size());
    kit_.meshes.push_back(std::move(mesh).build(name));
    add_label(letters[0], {name + "_x", index, 0, weight});
    add_label(letters[1], {name + "_z", index, 1, weight});
}

void ExampleBuilder::set_weight(char letter, double weight) {
    const auto found = label_of_.find(letter);
    require(
        found != label_of_.end(),
        std::string("no piece has the letter ") + letter + " that a weight was given for"
    );
    example_.pieces[found->second].weight = weight;
}

void ExampleBuilder::add_floor(std::initializer_list<std::string_view> rows) {
    floors_.emplace_back(rows.begin(), rows.end());
}

void ExampleBuilder::add_floor(std::vector<std::string> rows) {
    floors_.push_back(std::move(rows));
}

void ExampleBuilder::set_boundary(const discrete::Boundary& boundary) {
    example_.boundary = boundary;
}

void ExampleBuilder::set_default_size(const GridSize& size) { example_.default_size = size; }

discrete::Example ExampleBuilder::build() && {
    require(!floors_.empty() && !floors_.front().empty(), "an example without floors");
    const std::size_t depth = floors_.front().size();
    const std::size_t width = floors_.front().front().size();
    for (std::size_t y = 0; y < floors_.size(); ++y) {
        require(floors_[y].size() == depth, "floor " + std::to_string(y) + " has another depth");
        for (std::size_t z = 0; z < depth; ++z) {
            const std::string place =
                " in floor " + std::to_string(y) + ", row " + std::to_string(z);
            require(floors_[y][z].size() == width, "a row of another width" + place);
            for (const char letter : floors_[y][z]) {
                const auto found = label_of_.find(letter);
                require(
                    found != label_of_.end(),
                    std::string("no piece has the letter ") + letter + place
                );
                example_.cells.push_back(found->second);
            }
        }
    }
    example_.size = {
        static_cast<std::int32_t>(width),
        static_cast<std::int32_t>(floors_.size()),
        static_cast<std::int32_t>(depth)};
    example_.kit = std::make_shared<const Kit>(std::move(kit_));
    return std::move(example_);
}

}  // namespace modelsynth::examples
