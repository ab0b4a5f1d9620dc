#pragma once

#include "solver/discrete/example.h"
#include "solver/examples/kit/mesh_builder.h"

#include <initializer_list>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace modelsynth::examples {

// Puts a discrete example together: materials, pieces under one-character names, floors as rows
// of characters one can read.
//
// A floor is one string per row from north to south, a character per cell from west to east. The
// floors are given from the bottom up. A character that no piece has ends the program with a
// message: built-in examples are code, and a fault in them is a fault of ours.
class ExampleBuilder {
  public:
    ExampleBuilder(std::string name, double width_m, double height_m, double depth_m);

    MaterialId add_material(Material material);

    // A piece without geometry.
    void add_empty(char letter, const std::string& name);

    // Another piece without geometry, which does not count as empty: the inside of a hill.
    void add_undrawn(char letter, const std::string& name, double weight = 1);

    // A piece with its own mesh.
    void add_piece(char letter, const std::string& name, MeshBuilder mesh, double weight = 1);

    // The same mesh in four turns, as four pieces: name_e (as built), name_n, name_w, name_s: the
    // side that was built facing east faces east, north, west, south. `letters` has four.
    void add_turned(
        std::string_view letters, const std::string& name, MeshBuilder mesh, double weight = 1
    );

    // The same mesh as built and turned once, as two pieces: name_x and name_z. For meshes that a
    // half turn does not change.
    void add_axial(
        std::string_view letters, const std::string& name, MeshBuilder mesh, double weight = 1
    );

    // Another weight for a piece that was added.
    void set_weight(char letter, double weight);

    void add_floor(std::initializer_list<std::string_view> rows);
    void add_floor(std::vector<std::string> rows);

    void set_boundary(const discrete::Boundary& boundary);
    void set_default_size(const GridSize& size);

    [[nodiscard]] discrete::Example build() &&;

  private:
    void add_label(char letter, discrete::Piece piece);

    discrete::Example example_;
    Kit kit_;
    std::map<char, Label> label_of_;
    std::vector<std::vector<std::string>> floors_;
};

}  // namespace modelsynth::examples
