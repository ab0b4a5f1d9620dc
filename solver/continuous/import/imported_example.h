#pragma once

#include "solver/continuous/example.h"
#include "solver/mesh/glb_scene.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace modelsynth::continuous {

// Where in a file something of an example comes from. Pointers are JSON Pointers, into the example
// as it is written in JSON and into the file's own JSON.
struct Source {
    std::string in_example;  // "/objects/2/shape"
    std::string in_file;     // "/nodes/5/extras/shape"
    std::string who;         // for people: node "dome"
};

// A field of the example that the extras of a file tell, in the form that it has in JSON examples
// or, where that is a list or an object, as a text of that form. Not looked into.
struct SaidField {
    Source source;
    std::shared_ptr<const Extra>
        value;  // shared, since thousands of objects may be of one material
};

// Takes a part of a file that cannot be used, and what is said of it after who it is.
using RefuseSource = std::function<void(const Source&, const std::string& why)>;

// An example as a file has it.
struct ImportedExample {
    Example example;  // its solids and objects, what nodes are the meshes of, and else defaults
    // The rest. A list of decorations goes after those that the example has; any other field takes
    // the place of the example's.
    std::vector<SaidField> said;
    std::vector<Source> sources;  // of objects, solids, shapes and decorations
};

}  // namespace modelsynth::continuous
