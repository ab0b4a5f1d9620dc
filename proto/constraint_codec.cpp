#include "proto/constraint_codec.h"

#include "proto/region_codec.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

namespace modelsynth::proto {

namespace {

using discrete::Constraint;
using discrete::Rule;

constexpr double kWeightMax = 1e6;
constexpr std::size_t kProfileMax = 4096;
constexpr std::array<const char*, 3> kAxisNames = {"x", "y", "z"};

std::uint32_t read_count(const Value& value, const RequestLimits& limits, std::uint32_t least) {
    const auto most = static_cast<std::int64_t>(limits.model_cells_max);
    return static_cast<std::uint32_t>(value.integer(least, most).value_or(least));
}

Rule read_count_rule(ObjectReader& reader, const Value& whole, const RequestLimits& limits) {
    discrete::Count count;
    const auto min = reader.optional("min");
    const auto max = reader.optional("max");
    if (!min && !max) {
        whole.fault("count needs \"min\", \"max\" or both");
    }
    if (min) {
        count.min = read_count(*min, limits, 0);
    }
    if (max) {
        count.max = read_count(*max, limits, 0);
    }
    return count;
}

Rule read_max_run(ObjectReader& reader, const RequestLimits& limits) {
    discrete::MaxRun run;
    if (const auto max = reader.required("max")) {
        run.max = static_cast<std::int32_t>(max->integer(1, limits.extent_max).value_or(1));
    }
    if (const auto axis = reader.optional("axis")) {
        if (const auto index = axis->one_of({"x", "y", "z"})) {
            run.axis = static_cast<std::uint8_t>(*index);
        }
    }
    return run;
}

Rule read_path(ObjectReader& reader, const RequestLimits& limits) {
    discrete::Path path;
    for (const auto& [name, cell] : {std::pair("from", &path.from), std::pair("to", &path.to)}) {
        if (const auto value = reader.required(name)) {
            *cell = value->cell(0, limits.extent_max).value_or(Cell{});
        }
    }
    return path;
}

Rule read_symmetry(ObjectReader& reader, const Value& whole, const RequestLimits& limits) {
    using Kind = discrete::Symmetry::Kind;
    discrete::Symmetry symmetry;
    int kinds = 0;
    if (const auto reflect = reader.optional("reflect")) {
        ++kinds;
        const auto axis = reflect->one_of({"x", "z"});
        symmetry.kind = axis == 1U ? Kind::kReflectZ : Kind::kReflectX;
    }
    if (const auto translate = reader.optional("translate")) {
        ++kinds;
        symmetry.kind = Kind::kTranslate;
        symmetry.translation =
            translate->cell(-limits.extent_max, limits.extent_max).value_or(Cell{1, 0, 0});
    }
    if (const auto rotate = reader.optional("rotate")) {
        ++kinds;
        const auto turns = rotate->integer(2, 4);
        if (turns == 3) {
            rotate->fault("must be 2, by half turns, or 4, by quarter turns");
        }
        symmetry.kind = turns == 4 ? Kind::kQuarterTurn : Kind::kHalfTurn;
    }
    if (kinds != 1) {
        whole.fault("symmetry needs one of \"reflect\", \"translate\" and \"rotate\"");
    }
    symmetry.mirror.emplace();
    if (const auto mirror = reader.optional("mirror")) {
        symmetry.mirror = read_mirror(*mirror, limits);
    }
    return symmetry;
}

Rule read_resemblance(ObjectReader& reader, const RequestLimits& limits) {
    discrete::Resemblance resemblance;
    if (const auto window = reader.optional("window")) {
        resemblance.window =
            static_cast<std::int32_t>(window->integer(1, limits.resemblance_window_max).value_or(1)
            );
    }
    if (const auto threshold = reader.optional("threshold")) {
        constexpr std::int64_t kThresholdMax = 10'000;
        resemblance.threshold =
            static_cast<std::int32_t>(threshold->integer(0, kThresholdMax).value_or(0));
    }
    return resemblance;
}

discrete::Term read_term(const Value& value, const RequestLimits& limits) {
    using Kind = discrete::Term::Kind;
    discrete::Term term;
    ObjectReader reader(value);
    const auto kind_value = reader.required("term");
    const auto kind = kind_value ? kind_value->one_of(discrete::kTermNames) : std::nullopt;
    term.kind = static_cast<Kind>(kind.value_or(0));
    if (const auto weight = reader.optional("weight")) {
        term.weight = weight->number(-kWeightMax, kWeightMax).value_or(1);
    }
    if (const auto pieces = reader.optional("pieces")) {
        term.pieces =
            pieces->strings(1, limits.pieces_max, limits.name_characters_max).value_or(term.pieces);
    }
    if (kind && (term.kind == Kind::kDensity || term.kind == Kind::kCount)) {
        if (const auto target = reader.optional("target")) {
            const double most =
                term.kind == Kind::kDensity ? 1 : static_cast<double>(limits.model_cells_max);
            term.target = target->number(0, most);
        }
    }
    if (kind && term.kind == Kind::kHeightProfile) {
        const auto profile = reader.required("profile");
        const auto shares = profile ? profile->array(1, kProfileMax) : std::nullopt;
        for (std::size_t i = 0; shares && i < shares->size(); ++i) {
            term.profile.push_back((*shares)[i].number(0, 1).value_or(0));
        }
    }
    if (kind || !kind_value) {
        reader.finish();  // of an unknown kind no field can be called unknown
    }
    return term;
}

std::vector<discrete::Term> read_terms(ObjectReader& reader, const RequestLimits& limits) {
    std::vector<discrete::Term> terms;
    const auto value = reader.required("terms");
    const auto values = value ? value->array(1, limits.terms_max) : std::nullopt;
    for (std::size_t i = 0; values && i < values->size(); ++i) {
        terms.push_back(read_term((*values)[i], limits));
    }
    return terms;
}

Rule read_objective(ObjectReader& reader, const RequestLimits& limits) {
    discrete::Objective objective = {read_terms(reader, limits)};
    if (const auto temperature = reader.optional("temperature")) {
        objective.temperature = temperature->number(0, kWeightMax).value_or(0);
    }
    return objective;
}

Rule read_best_of(ObjectReader& reader, const RequestLimits& limits) {
    discrete::BestOf best = {read_terms(reader, limits)};
    if (const auto n = reader.required("n")) {
        best.n = static_cast<std::uint32_t>(n->integer(1, limits.best_of_max).value_or(1));
    }
    return best;
}

// The further fields of the kind.
Rule read_rule(
    const std::string& kind, ObjectReader& reader, const Value& whole, const RequestLimits& limits
) {
    if (kind == "symmetry") {
        return read_symmetry(reader, whole, limits);
    }
    if (kind == "resemblance") {
        return read_resemblance(reader, limits);
    }
    if (kind == "objective") {
        return read_objective(reader, limits);
    }
    if (kind == "best_of") {
        return read_best_of(reader, limits);
    }
    if (kind == "forbidden") {
        return discrete::Forbidden{};
    }
    if (kind == "probability") {
        const auto weight = reader.required("weight");
        return discrete::Probability{weight ? weight->number(0, kWeightMax).value_or(1) : 1};
    }
    if (kind == "count") {
        return read_count_rule(reader, whole, limits);
    }
    if (kind == "separation") {
        const auto distance = reader.required("distance");
        const auto most = limits.separation_max;
        return discrete::Separation{
            distance ? static_cast<std::int32_t>(distance->integer(1, most).value_or(1)) : 1};
    }
    if (kind == "max_run") {
        return read_max_run(reader, limits);
    }
    if (kind == "connected") {
        return discrete::Connected{};
    }
    if (kind == "acyclic") {
        return discrete::Acyclic{};
    }
    if (kind == "path") {
        return read_path(reader, limits);
    }
    return discrete::Fixed{};
}

Constraint read_constraint(const Value& value, const RequestLimits& limits) {
    Constraint constraint;
    ObjectReader reader(value);
    const auto kind_value = reader.required("kind");
    const auto kind = kind_value ? kind_value->one_of(discrete::kRuleNames) : std::nullopt;
    if (kind) {
        constraint.rule = read_rule(discrete::kRuleNames.at(*kind), reader, value, limits);
    }
    if (!kind || discrete::names_pieces(constraint.rule)) {
        if (const auto pieces = reader.required("pieces")) {
            constraint.pieces = pieces->strings(1, limits.pieces_max, limits.name_characters_max)
                                    .value_or(constraint.pieces);
        }
    }
    if (!kind || discrete::has_region(constraint.rule)) {
        constraint.region = read_region(reader, limits);
    }
    if (kind || !kind_value) {
        reader.finish();  // of an unknown kind no field can be called unknown
    }
    return constraint;
}

OrderedJson write_terms(const std::vector<discrete::Term>& terms) {
    OrderedJson list = OrderedJson::array();
    for (const discrete::Term& term : terms) {
        OrderedJson written = {
            {"term", discrete::kTermNames.at(static_cast<std::size_t>(term.kind))},
            {"weight", term.weight}};
        if (!term.pieces.empty()) {
            written["pieces"] = term.pieces;
        }
        if (term.target) {
            written["target"] = *term.target;
        }
        if (!term.profile.empty()) {
            written["profile"] = term.profile;
        }
        list.push_back(std::move(written));
    }
    return list;
}

// Writes the further fields of a rule.
struct RuleWriter {
    OrderedJson& written;

    void operator()(const discrete::Fixed& /*rule*/) const {}

    void operator()(const discrete::Forbidden& /*rule*/) const {}

    void operator()(const discrete::Connected& /*rule*/) const {}

    void operator()(const discrete::Acyclic& /*rule*/) const {}

    void operator()(const discrete::Probability& rule) const { written["weight"] = rule.weight; }

    void operator()(const discrete::Count& rule) const {
        written["min"] = rule.min;
        if (rule.max) {
            written["max"] = *rule.max;
        }
    }

    void operator()(const discrete::Separation& rule) const { written["distance"] = rule.distance; }

    void operator()(const discrete::MaxRun& rule) const {
        written["max"] = rule.max;
        if (rule.axis) {
            written["axis"] = kAxisNames.at(*rule.axis);
        }
    }

    void operator()(const discrete::Path& rule) const {
        written["from"] = write_cell(rule.from);
        written["to"] = write_cell(rule.to);
    }

    void operator()(const discrete::Symmetry& rule) const {
        using Kind = discrete::Symmetry::Kind;
        switch (rule.kind) {
            case Kind::kReflectX:
                written["reflect"] = "x";
                break;
            case Kind::kReflectZ:
                written["reflect"] = "z";
                break;
            case Kind::kHalfTurn:
                written["rotate"] = 2;
                break;
            case Kind::kQuarterTurn:
                written["rotate"] = 4;
                break;
            case Kind::kTranslate:
                written["translate"] = write_cell(rule.translation);
                break;
        }
        if (rule.mirror) {
            written["mirror"] = OrderedJson::object();
            for (const auto& [piece, image] : *rule.mirror) {
                written["mirror"][piece] = image;
            }
        }
    }

    void operator()(const discrete::Resemblance& rule) const {
        written["window"] = rule.window;
        written["threshold"] = rule.threshold;
    }

    void operator()(const discrete::Objective& rule) const {
        written["terms"] = write_terms(rule.terms);
        written["temperature"] = rule.temperature;
    }

    void operator()(const discrete::BestOf& rule) const {
        written["terms"] = write_terms(rule.terms);
        written["n"] = rule.n;
    }
};

}  // namespace

std::optional<std::vector<std::pair<std::string, std::string>>> read_mirror(
    const Value& value, const RequestLimits& limits
) {
    if (value.json() == "auto") {
        return std::nullopt;
    }
    std::vector<std::pair<std::string, std::string>> mirror;
    if (!value.json().is_object()) {
        value.fault("must be an object that names images by what they are of, or \"auto\"");
        return mirror;
    }
    for (const auto& [name, json] : value.json().items()) {
        const Value image(json, value.pointer() + "/" + pointer_part(name), value.faults());
        if (count_characters(name) > limits.name_characters_max) {
            image.fault("the name is too long");
        } else if (auto text = image.string(limits.name_characters_max)) {
            mirror.emplace_back(name, std::move(*text));
        }
    }
    return mirror;
}

std::vector<Constraint> read_constraints(const Value& value, const RequestLimits& limits) {
    std::vector<Constraint> constraints;
    const auto values = constraint_values(value, limits);
    if (!values) {
        return constraints;
    }
    std::size_t member_rules = 0;
    for (const Value& one : *values) {
        Constraint& constraint = constraints.emplace_back(read_constraint(one, limits));
        if (is_member_rule(constraint.rule) && ++member_rules == limits.member_rules_max + 1) {
            value.fault(
                "has more than " + std::to_string(limits.member_rules_max) +
                    " constraints of the kinds that speak of many cells together; the limit is "
                    "member_rules_max",
                true
            );
        }
    }
    return constraints;
}

OrderedJson write_constraints(const std::vector<Constraint>& constraints) {
    OrderedJson list = OrderedJson::array();
    for (const Constraint& constraint : constraints) {
        OrderedJson written = {{"kind", discrete::kRuleNames.at(constraint.rule.index())}};
        if (discrete::names_pieces(constraint.rule)) {
            written["pieces"] = constraint.pieces;
        }
        std::visit(RuleWriter{written}, constraint.rule);
        write_region(constraint.region, written);
        list.push_back(std::move(written));
    }
    return list;
}

}  // namespace modelsynth::proto
