// What the built-in examples become: the labels as a hash, which must be the same on every
// machine, and counts by which one sees when a change of the search or of an example dulls the
// models.

#include "proto/frame.h"
#include "solver/discrete/synthesis.h"
#include "solver/examples/built_in.h"
#include "tests/golden/golden.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

namespace modelsynth {
namespace {

class Silent final : public Observer {
  public:
    void on_start(std::uint32_t, std::span<const Label>) override {}

    void on_block(const BlockReport&) override {}
};

// Cells above the ground floor with a piece that is drawn, joined by their faces.
struct Objects {
    std::size_t count = 0;
    std::size_t largest = 0;
};

Objects find_objects(const discrete::Example& example, const discrete::Synthesis& model) {
    const GridSize size = model.size;
    std::vector<bool> open(model.labels.size());
    for (std::size_t site = 0; site < open.size(); ++site) {
        open[site] = size.cell(site).y > 0 && example.pieces[model.labels[site]].mesh.has_value();
    }
    Objects objects;
    std::vector<std::size_t> stack;
    for (std::size_t start = 0; start < open.size(); ++start) {
        if (!open[start]) {
            continue;
        }
        open[start] = false;
        stack = {start};
        std::size_t cells = 0;
        while (!stack.empty()) {
            const Cell cell = size.cell(stack.back());
            stack.pop_back();
            ++cells;
            for (const Cell& next :
                 {Cell{cell.x + 1, cell.y, cell.z},
                  Cell{cell.x - 1, cell.y, cell.z},
                  Cell{cell.x, cell.y + 1, cell.z},
                  Cell{cell.x, cell.y - 1, cell.z},
                  Cell{cell.x, cell.y, cell.z + 1},
                  Cell{cell.x, cell.y, cell.z - 1}}) {
                if (size.contains(next) && open[size.index(next)]) {
                    open[size.index(next)] = false;
                    stack.push_back(size.index(next));
                }
            }
        }
        ++objects.count;
        objects.largest = std::max(objects.largest, cells);
    }
    return objects;
}

std::vector<std::size_t> count_labels(std::size_t pieces, const std::vector<Label>& cells) {
    std::vector<std::size_t> counts(pieces);
    for (const Label label : cells) {
        ++counts[label];
    }
    return counts;
}

std::string permille(std::size_t part, std::size_t whole) {
    std::string text(16, '\0');
    text.resize(static_cast<std::size_t>(std::snprintf(
        text.data(),
        text.size(),
        "%7.2f",
        1000.0 * static_cast<double>(part) / static_cast<double>(whole)
    )));
    return text;
}

class BuiltInModels : public ::testing::TestWithParam<std::size_t> {};

TEST_P(BuiltInModels, AreWhatTheyWere) {
    const discrete::Example& example = *examples::built_in()[GetParam()];
    discrete::Parameters parameters;
    parameters.size = example.default_size;
    parameters = fill_defaults(parameters, example);
    std::string text;
    std::vector<std::size_t> totals(example.pieces.size());
    std::size_t cells = 0;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        Silent observer;
        const auto model = discrete::synthesise(example, parameters, seed, observer, {});
        ASSERT_TRUE(model) << model.error().message;
        const Objects objects = find_objects(example, *model);
        text += "seed " + std::to_string(seed) + ": labels " +
                testing::sha256_hex(proto::encode_labels(model->labels)) + ", blocks " +
                std::to_string(model->stats.blocks.accepted()) + " accepted " +
                std::to_string(model->stats.blocks.reverted) + " reverted, changed" +
                permille(
                    static_cast<std::size_t>(
                        model->stats.changed * static_cast<double>(model->labels.size()) + 0.5
                    ),
                    model->labels.size()
                ) +
                " in 1000, objects " + std::to_string(objects.count) + ", the largest of " +
                std::to_string(objects.largest) + " cells\n";
        const auto counts = count_labels(totals.size(), model->labels);
        for (std::size_t label = 0; label < totals.size(); ++label) {
            totals[label] += counts[label];
        }
        cells += model->labels.size();
    }
    text += "\nof 1000 cells in the example, in the models, piece\n";
    const auto in_example = count_labels(totals.size(), example.cells);
    for (std::size_t label = 0; label < totals.size(); ++label) {
        text += permille(in_example[label], example.cells.size()) + " " +
                permille(totals[label], cells) + "  " + example.pieces[label].name + "\n";
    }
    testing::expect_golden(example.name + ".txt", text);
}

INSTANTIATE_TEST_SUITE_P(
    Golden,
    BuiltInModels,
    ::testing::Range<std::size_t>(0, 3),
    [](const auto& tested) { return examples::built_in()[tested.param]->name; }
);

}  // namespace
}  // namespace modelsynth
