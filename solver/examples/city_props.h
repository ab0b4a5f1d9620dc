#pragma once

#include "solver/examples/city_materials.h"

namespace modelsynth::examples {

// Things that stand about in a city. Those without a place stand in the middle of the cell.

// A post whose lantern hangs `reach` metres towards south.
void add_lamp_post(MeshBuilder& mesh, const CityMaterials& m, float x, float z, float reach);
// Along x, on the floor y = 0.
void add_car(MeshBuilder& mesh, const CityMaterials& m, MaterialId paint);
void add_tree(MeshBuilder& mesh, const CityMaterials& m, float foot, float scale);
void add_bench(MeshBuilder& mesh, const CityMaterials& m);
void add_fountain(MeshBuilder& mesh, const CityMaterials& m);
// A table with two stools under a parasol.
void add_table(MeshBuilder& mesh, const CityMaterials& m, float x, float z);
// A market stall under a striped cloth.
void add_stall(MeshBuilder& mesh, const CityMaterials& m);

}  // namespace modelsynth::examples
