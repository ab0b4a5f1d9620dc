#include "tests/bench/pattern_set.h"

#include <algorithm>
#include <map>
#include <utility>

namespace modelsynth::bench {

namespace {

std::string cut_window(const Image& sample, std::size_t x, std::size_t z, std::size_t window) {
    std::string pattern;
    for (std::size_t row = 0; row < window; ++row) {
        const std::string& pixels = sample[(z + row) % sample.size()];
        for (std::size_t column = 0; column < window; ++column) {
            pattern += pixels[(x + column) % pixels.size()];
        }
    }
    return pattern;
}

// A quarter turn clockwise.
std::string turn(const std::string& pattern, std::size_t window) {
    std::string turned;
    for (std::size_t row = 0; row < window; ++row) {
        for (std::size_t column = 0; column < window; ++column) {
            turned += pattern[(window - 1 - column) * window + row];
        }
    }
    return turned;
}

std::string transpose(const std::string& pattern, std::size_t window) {
    std::string transposed;
    for (std::size_t row = 0; row < window; ++row) {
        for (std::size_t column = 0; column < window; ++column) {
            transposed += pattern[column * window + row];
        }
    }
    return transposed;
}

// The rectangle of a pattern that lies in the columns and rows given, as text.
std::string part_of(
    const std::string& pattern,
    std::size_t window,
    std::pair<std::size_t, std::size_t> columns,
    std::pair<std::size_t, std::size_t> rows
) {
    std::string part;
    for (std::size_t row = rows.first; row < rows.second; ++row) {
        part += pattern.substr(row * window + columns.first, columns.second - columns.first);
    }
    return part;
}

// Joins every pattern to those that go on from it a pixel along the axis.
void allow_overlaps(const PatternSet& set, std::uint8_t axis, discrete::Example& example) {
    const auto window = static_cast<std::size_t>(set.window);
    const std::pair<std::size_t, std::size_t> all = {0, window};
    const auto overlap = [&](const std::string& pattern, std::size_t first) {
        const std::pair part = {first, first + window - 1};
        return axis == 0 ? part_of(pattern, window, part, all)
                         : part_of(pattern, window, all, part);
    };
    std::multimap<std::string, Label> by_beginning;
    for (std::size_t label = 0; label < set.patterns.size(); ++label) {
        by_beginning.emplace(overlap(set.patterns[label], 0), static_cast<Label>(label));
    }
    for (std::size_t label = 0; label < set.patterns.size(); ++label) {
        const auto [begin, end] = by_beginning.equal_range(overlap(set.patterns[label], 1));
        for (auto next = begin; next != end; ++next) {
            example.adjacency.push_back({axis, static_cast<Label>(label), next->second});
        }
    }
}

}  // namespace

PatternSet find_patterns(const Image& sample, const PatternOptions& options) {
    const auto window = static_cast<std::size_t>(options.window);
    const std::size_t lost = options.is_toroidal ? 0 : window - 1;
    PatternSet set;
    set.window = options.window;
    std::map<std::string, std::size_t> known;
    const auto meet = [&](const std::string& pattern) {
        const auto [found, is_new] = known.emplace(pattern, set.patterns.size());
        if (is_new) {
            set.patterns.push_back(pattern);
            set.counts.push_back(0);
        }
        ++set.counts[found->second];
    };
    for (std::size_t z = 0; z + lost < sample.size(); ++z) {
        for (std::size_t x = 0; x + lost < sample[z].size(); ++x) {
            std::string pattern = cut_window(sample, x, z, window);
            for (int turns = options.has_symmetries ? 4 : 1; turns > 0; --turns) {
                meet(pattern);
                if (options.has_symmetries) {
                    meet(transpose(pattern, window));
                }
                pattern = turn(pattern, window);
            }
        }
    }
    return set;
}

discrete::Example make_pattern_example(const std::string& name, const PatternSet& set) {
    discrete::Example example;
    example.name = name;
    for (std::size_t label = 0; label < set.patterns.size(); ++label) {
        const double weight = set.counts[label];
        example.pieces.push_back({set.patterns[label], {}, 0, weight});
    }
    allow_overlaps(set, 0, example);
    allow_overlaps(set, 2, example);
    return example;
}

Image read_image(const PatternSet& set, const GridSize& size, std::span<const Label> labels) {
    const auto window = static_cast<std::size_t>(set.window);
    const auto width = static_cast<std::size_t>(size.x);
    const auto depth = static_cast<std::size_t>(size.z);
    Image image(depth + window - 1);
    for (std::size_t z = 0; z < image.size(); ++z) {
        const std::size_t cell_z = std::min(z, depth - 1);
        for (std::size_t x = 0; x < width + window - 1; ++x) {
            const std::size_t cell_x = std::min(x, width - 1);
            const std::string& pattern = set.patterns[labels[cell_z * width + cell_x]];
            image[z] += pattern[(z - cell_z) * window + (x - cell_x)];
        }
    }
    return image;
}

}  // namespace modelsynth::bench
