#include "proto/analysis_codec.h"

#include "proto/json.h"
#include "solver/continuous/display/figure_drawing.h"
#include "solver/continuous/reading/reading.h"
#include "solver/discrete/analysis/success_drawing.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

namespace modelsynth::proto {

namespace {

using discrete::Counterexample;
using discrete::Infallibility;
using discrete::InfallibilityProof;
using discrete::InfallibilityVerdict;

// What JavaScript's numbers hold.
constexpr std::uint64_t kCountMax = (std::uint64_t{1} << 53) - 1;

const char* name_of(Infallibility kind) {
    switch (kind) {
        case Infallibility::kInfallible:
            return "infallible";
        case Infallibility::kFallible:
            return "fallible";
        case Infallibility::kUnknown:
            break;
    }
    return "unknown";
}

const char* name_of(discrete::SplitMethod method) {
    return method == discrete::SplitMethod::kRules ? "rules" : "cells";
}

const char* name_of(discrete::SplitProof proof) {
    return proof == discrete::SplitProof::kEquation311 ? "equation_3_11" : "region";
}

OrderedJson write_size(const GridSize& size) {
    return OrderedJson::array({size.x, size.y, size.z});
}

class Writer {
  public:
    Writer(const discrete::Example& example, const discrete::Analysis& analysis)
        : example_(example), analysis_(analysis) {}

    [[nodiscard]] OrderedJson proof() const {
        const InfallibilityVerdict& verdict = analysis_.verdict;
        if (verdict.counterexample) {
            return counterexample(*verdict.counterexample);
        }
        switch (verdict.proof) {
            case InfallibilityProof::kOneAxis:
                return {{"kind", "one_axis"}};
            case InfallibilityProof::kEquation311:
                return {{"kind", "equation_3_11"}};
            case InfallibilityProof::kRegion:
                return {{"kind", "region"}, {"region", write_size(*verdict.region)}};
            case InfallibilityProof::kNone:
                break;
        }
        return nullptr;
    }

    // The pieces that several labels stand for, and those that none does; null where no splitting
    // was found.
    [[nodiscard]] OrderedJson splitting() const {
        if (!analysis_.splitting) {
            return nullptr;
        }
        const discrete::Splitting& splitting = *analysis_.splitting;
        std::map<Label, std::size_t> copies;
        for (const Label original : splitting.originals) {
            ++copies[original];
        }
        OrderedJson split = OrderedJson::array();
        for (const auto& [label, count] : copies) {
            if (count > 1) {
                split.push_back({{"piece", example_.pieces[label].name}, {"into", count}});
            }
        }
        OrderedJson lost = OrderedJson::array();
        for_each_label(splitting.lost.words(), [&](Label label) {
            lost.push_back(example_.pieces[label].name);
        });
        return {
            {"labels", splitting.originals.size()},
            {"method", name_of(splitting.method)},
            {"proof", name_of(splitting.proof)},
            {"split", std::move(split)},
            {"lost", std::move(lost)}};
    }

    [[nodiscard]] OrderedJson warnings() const {
        OrderedJson list = OrderedJson::array();
        for (const discrete::Warning& warning : analysis_.warnings) {
            OrderedJson pieces = OrderedJson::array();
            for (const Label label : warning.labels) {
                pieces.push_back(example_.pieces[label].name);
            }
            list.push_back(
                {{"code", discrete::name_of(warning.code)},
                 {"message", warning.message},
                 {"pieces", std::move(pieces)}}
            );
        }
        return list;
    }

    [[nodiscard]] OrderedJson success() const {
        OrderedJson list = OrderedJson::array();
        for (const discrete::SuccessPoint& point : analysis_.success) {
            list.push_back(
                {{"size", write_size(point.size)},
                 {"runs", point.runs},
                 {"successes", point.successes}}
            );
        }
        return list;
    }

    [[nodiscard]] OrderedJson counts() const {
        OrderedJson list = OrderedJson::array();
        for (const auto& [size, models] : analysis_.counts) {
            list.push_back(
                {{"size", write_size(size)},
                 {"models", std::min(models.count, kCountMax)},
                 {"exact", models.is_exact && models.count <= kCountMax}}
            );
        }
        return list;
    }

  private:
    [[nodiscard]] OrderedJson counterexample(const Counterexample& found) const {
        return {
            {"kind", "counterexample"},
            {"message", discrete::describe(found, example_)},
            {"box", write_size(found.box)},
            {"cells", placed(found.cells)},
            {"choice", found.choice ? place(*found.choice) : OrderedJson(nullptr)},
            {"core", placed(found.core)}};
    }

    [[nodiscard]] OrderedJson place(const discrete::PlacedLabel& one) const {
        return {
            {"cell", OrderedJson::array({one.cell.x, one.cell.y, one.cell.z})},
            {"piece", example_.pieces[one.label].name}};
    }

    [[nodiscard]] OrderedJson placed(const std::vector<discrete::PlacedLabel>& labels) const {
        OrderedJson list = OrderedJson::array();
        for (const discrete::PlacedLabel& one : labels) {
            list.push_back(place(one));
        }
        return list;
    }

    const discrete::Example& example_;
    const discrete::Analysis& analysis_;
};

const discrete::Example& discrete_of(const Example& example) {
    return *std::get<std::shared_ptr<const discrete::Example>>(example);
}

OrderedJson write_figures(const std::vector<continuous::Analysis::Figure>& figures) {
    OrderedJson list = OrderedJson::array();
    for (const continuous::Analysis::Figure& figure : figures) {
        OrderedJson objects = OrderedJson::array();
        OrderedJson expressions = OrderedJson::object();
        for (const auto& [object, expression] : figure.parts) {
            objects.push_back(object);
            expressions[object] = expression ? OrderedJson(*expression) : OrderedJson(nullptr);
        }
        list.push_back(
            {{"number", list.size()},
             {"rank", figure.rank},
             {"objects", std::move(objects)},
             {"expressions", std::move(expressions)},
             {"families", figure.families}}
        );
    }
    return list;
}

OrderedJson write(const continuous::Analysis& analysis, const std::string& self) {
    OrderedJson families = OrderedJson::array();
    for (const continuous::Analysis::Family& family : analysis.families) {
        families.push_back(
            {{"name", "h" + std::to_string(families.size() + 1)},
             {"normal", family.normal},
             {"spacing", family.spacing}}
        );
    }
    OrderedJson warnings = OrderedJson::array();
    for (const std::string& message : analysis.warnings) {
        warnings.push_back({{"code", "planes"}, {"message", message}});
    }
    return {
        {"verdict", "unknown"},
        {"proof", nullptr},
        {"labels", analysis.figures},
        {"corner_labels", analysis.corner_figures},
        {"families", std::move(families)},
        {"figures_listed", analysis.figure_list.size()},
        {"figure_list", write_figures(analysis.figure_list)},
        {"warnings", std::move(warnings)},
        {"urls",
         {{"self", self + "/analysis"}, {"example", self}, {"figures", self + "/figures.svg"}}}};
}

}  // namespace

std::string analysis_json(const Example& example, const std::string& id, const Analysis& analysis) {
    if (const auto* solids = std::get_if<continuous::Analysis>(&analysis)) {
        return dump(write(*solids, "/v1/examples/" + id));
    }
    const auto& discrete = std::get<discrete::Analysis>(analysis);
    const Writer writer(discrete_of(example), discrete);
    const std::string self = "/v1/examples/" + id;
    return dump(OrderedJson{
        {"verdict", name_of(discrete.verdict.kind)},
        {"proof", writer.proof()},
        {"splitting", writer.splitting()},
        {"description", discrete.verdict.description},
        {"labels", discrete_of(example).pieces.size()},
        {"warnings", writer.warnings()},
        {"success", writer.success()},
        {"models", writer.counts()},
        {"urls",
         {{"self", self + "/analysis"}, {"example", self}, {"drawing", self + "/success.svg"}}}});
}

std::optional<std::string> success_drawing(const Example& example, const Analysis& analysis) {
    if (!std::holds_alternative<discrete::Analysis>(analysis)) {
        return std::nullopt;
    }
    const std::array<discrete::SuccessCurve, 1> curves = {
        {{discrete_of(example).name, std::get<discrete::Analysis>(analysis).success}}};
    return discrete::draw_success_curves(curves);
}

std::optional<std::size_t> figure_count(const Example& example) {
    const auto* solids = std::get_if<std::shared_ptr<const continuous::ExampleReading>>(&example);
    return solids == nullptr ? std::nullopt : std::optional((*solids)->figures().count());
}

std::string figure_drawing(const Example& example, std::optional<std::size_t> number) {
    const auto& solids = *std::get<std::shared_ptr<const continuous::ExampleReading>>(example);
    return number ? continuous::draw_figure(solids, *number)
                  : continuous::draw_figure_sheet(solids);
}

}  // namespace modelsynth::proto
