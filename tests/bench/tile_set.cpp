#include "tests/bench/tile_set.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace modelsynth::bench {

namespace {

using Edges = std::array<std::string, 4>;

enum Side : std::size_t { kNorth, kEast, kSouth, kWest };

std::string backwards(const std::string& edge) { return {edge.rbegin(), edge.rend()}; }

// A quarter turn clockwise.
Edges turn(const Edges& edges) {
    return {edges[kWest], edges[kNorth], edges[kEast], edges[kSouth]};
}

// East and west change places.
Edges mirror(const Edges& edges) {
    return {
        backwards(edges[kNorth]),
        backwards(edges[kWest]),
        backwards(edges[kSouth]),
        backwards(edges[kEast])};
}

std::vector<Edges> find_variants(const Edges& drawn, Variants variants) {
    const int turns = variants == Variants::kAsDrawn ? 1 : 4;
    const int mirrorings = variants == Variants::kTurnedAndMirrored ? 2 : 1;
    std::vector<Edges> found;
    Edges edges = drawn;
    for (int mirroring = 0; mirroring < mirrorings; ++mirroring) {
        for (int i = 0; i < turns; ++i) {
            if (std::find(found.begin(), found.end(), edges) == found.end()) {
                found.push_back(edges);
            }
            edges = turn(edges);
        }
        edges = mirror(drawn);
    }
    return found;
}

}  // namespace

discrete::Example make_tile_example(
    const std::string& name, std::span<const Tile> tiles, Variants variants
) {
    discrete::Example example;
    example.name = name;
    std::vector<Edges> edges;  // by label
    for (const Tile& tile : tiles) {
        for (const Edges& variant : find_variants(tile.edges, variants)) {
            const std::string number = std::to_string(example.pieces.size());
            example.pieces.push_back({tile.name + " " + number, {}, 0, tile.weight});
            edges.push_back(variant);
        }
    }
    for (std::size_t lower = 0; lower < edges.size(); ++lower) {
        for (std::size_t upper = 0; upper < edges.size(); ++upper) {
            const auto pair = std::pair(static_cast<Label>(lower), static_cast<Label>(upper));
            if (edges[lower][kEast] == backwards(edges[upper][kWest])) {
                example.adjacency.push_back({0, pair.first, pair.second});
            }
            if (edges[lower][kSouth] == backwards(edges[upper][kNorth])) {
                example.adjacency.push_back({2, pair.first, pair.second});
            }
        }
    }
    return example;
}

}  // namespace modelsynth::bench
