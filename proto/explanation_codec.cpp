#include "proto/explanation_codec.h"

#include "proto/limits.h"
#include "solver/discrete/explanation/contradiction.h"

#include <utility>

namespace modelsynth::proto {

namespace {

OrderedJson array_of(const Cell& cell) { return OrderedJson::array({cell.x, cell.y, cell.z}); }

OrderedJson document_of(const discrete::Contradiction::NamedCell& place) {
    OrderedJson labels = OrderedJson::array();
    for (const std::string& label : place.labels) {
        if (labels.size() == kLabelsListedMax) {
            break;
        }
        labels.push_back(label);
    }
    OrderedJson document = {{"cell", array_of(place.cell)}, {"labels", std::move(labels)}};
    if (place.labels.size() > kLabelsListedMax) {
        document["more"] = place.labels.size() - kLabelsListedMax;
    }
    return document;
}

OrderedJson document_of(const discrete::Contradiction& conflict) {
    OrderedJson constraints = OrderedJson::array();
    for (const auto& constraint : conflict.constraints) {
        constraints.push_back({{"index", constraint.index}, {"kind", constraint.kind}});
    }
    OrderedJson cells = OrderedJson::array();
    for (const auto& place : conflict.cells) {
        cells.push_back(document_of(place));
    }
    return {
        {"sides", conflict.sides},
        {"constraints", std::move(constraints)},
        {"periodic", conflict.periodic},
        {"removed", conflict.removed},
        {"origin", conflict.has_origin},
        {"cells", std::move(cells)},
        {"minimal", conflict.is_minimal}};
}

}  // namespace

void add_explanation(OrderedJson& document, const std::any& explanation) {
    if (const auto* conflict = std::any_cast<discrete::Contradiction>(&explanation)) {
        document["conflict"] = document_of(*conflict);
    } else if (const auto* dead_ends = std::any_cast<discrete::DeadEnds>(&explanation)) {
        OrderedJson hottest = OrderedJson::array();
        for (const auto& hot : dead_ends->hottest) {
            hottest.push_back({{"cell", array_of(hot.cell)}, {"times", hot.times}});
        }
        document["hottest"] = std::move(hottest);
    }
}

}  // namespace modelsynth::proto
