// Examples of solids that come as binary glTF: solids from meshes, and whatever else a JSON example
// may say from extras. All of it is put together as the JSON example that says the same, so that it
// is checked once, can be shown and can be sent again; faults are told at their places in the file.

#include "proto/continuous_codec.h"
#include "proto/example_codec.h"
#include "proto/json.h"
#include "solver/continuous/import/mesh_import.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <variant>

namespace modelsynth::proto {

namespace {

using continuous::ImportedExample;
using continuous::SaidField;
using continuous::Source;

// Lists and objects, which may be told as a text of JSON, since editors such as Blender let one
// type little else.
constexpr std::array<std::string_view, 10> kStructured = {
    "size",
    "bounds",
    "dimensions",
    "connected",
    "constraints",
    "shape",
    "decorations",
    "even",
    "edges",
    "corners"};
// Lists of words, which may be told as a text of these.
constexpr std::array<std::string_view, 3> kWords = {"even", "edges", "corners"};

template <std::size_t kCount>
bool is_among(const std::array<std::string_view, kCount>& names, std::string_view name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

std::string_view field_name(const SaidField& field) {
    const std::string_view pointer = field.source.in_example;
    return pointer.substr(pointer.rfind('/') + 1);
}

// As JSON, of so many bytes at most; nests no deeper than the file, which was checked.
class ExtraWriter {
  public:
    explicit ExtraWriter(std::size_t bytes_max) : left_(bytes_max) {}

    // Fails when that is more than what is left.
    std::optional<Json> write(const Extra& extra) {
        Json json = json_of(extra);
        return is_full_ ? std::nullopt : std::optional(std::move(json));
    }

  private:
    bool take(std::size_t bytes) {
        is_full_ = is_full_ || bytes > left_;
        left_ -= is_full_ ? 0 : bytes;
        return !is_full_;
    }

    Json json_of(const Extra& extra) {
        if (!take(1)) {
            return nullptr;
        }
        if (const auto* flag = std::get_if<bool>(&extra.value)) {
            return *flag;
        }
        if (const auto* number = std::get_if<double>(&extra.value)) {
            constexpr double kWholeMax = 9007199254740992;  // 2^53
            if (std::abs(*number) <= kWholeMax && *number == std::floor(*number)) {
                return static_cast<std::int64_t>(*number);
            }
            return *number;
        }
        if (const auto* text = std::get_if<std::string>(&extra.value)) {
            return take(text->size()) ? Json(*text) : Json();
        }
        if (const auto* list = std::get_if<Extra::List>(&extra.value)) {
            Json json = Json::array();
            for (const Extra& item : *list) {
                json.push_back(json_of(item));
                if (is_full_) {
                    break;
                }
            }
            return json;
        }
        if (const auto* members = std::get_if<Extra::Members>(&extra.value)) {
            Json json = Json::object();
            for (const auto& [name, member] : *members) {
                json[name] = take(name.size()) ? json_of(member) : Json();
                if (is_full_) {
                    break;
                }
            }
            return json;
        }
        return nullptr;
    }

    std::size_t left_;
    bool is_full_ = false;
};

Json words_of(std::string_view text) {
    Json words = Json::array();
    constexpr std::string_view kBetween = " ,";
    while (true) {
        const std::size_t begin = text.find_first_not_of(kBetween);
        if (begin == std::string_view::npos) {
            return words;
        }
        text.remove_prefix(begin);
        words.push_back(std::string(text.substr(0, text.find_first_of(kBetween))));
        text.remove_prefix(words.back().get_ref<const std::string&>().size());
    }
}

class GlbExample {
  public:
    GlbExample(ImportedExample imported, const RequestLimits& limits)
        : limits_(limits),
          writer_(limits.glb_bytes_max),
          sources_(std::move(imported.sources)),
          said_(std::move(imported.said)) {
        if (imported.example.name.empty()) {
            imported.example.name = "solids";
        }
        document_ = Json::parse(dump(write_solids(imported.example)));
        geometry_count_ = sources_.size();
    }

    Parsed<ExampleUpload> read() {
        for (const SaidField& field : said_) {
            if (auto value = value_of(field)) {
                put(field.source, std::move(*value));
            }
        }
        if (faults_.empty()) {
            auto upload = parse_example(dump(document_), limits_);
            if (upload || upload.error().errors.empty()) {
                return upload;
            }
            for (const Fault& fault : upload.error().errors) {
                faults_.add_all("", {in_file(fault)});
            }
        }
        Problem problem = make_problem("invalid-request", "the example cannot be used");
        problem.errors = faults_.take();
        return tl::unexpected(std::move(problem));
    }

  private:
    std::optional<Json> value_of(const SaidField& field) {
        auto written = writer_.write(*field.value);
        if (!written) {
            faults_.add(
                field.source.in_file,
                field.source.who + ": with all that nodes and materials say of objects more than " +
                    std::to_string(limits_.glb_bytes_max) + " bytes",
                true
            );
            return std::nullopt;
        }
        Json value = std::move(*written);
        const std::string_view name = field_name(field);
        if (name == "turned" && (value == 0 || value == 1)) {
            return Json(value == 1);  // older editors have no other flags
        }
        if (!value.is_string() || !is_among(kStructured, name)) {
            return value;
        }
        const auto& text = value.get_ref<const std::string&>();
        if (is_among(kWords, name) && !text.starts_with('[')) {
            return words_of(text);
        }
        auto parsed = parse_json(text, limits_.json);
        if (!parsed) {
            faults_.add(
                field.source.in_file,
                field.source.who + ": the text is no JSON: " + parsed.error().detail
            );
            return std::nullopt;
        }
        return std::move(*parsed);
    }

    void put(const Source& source, Json value) {
        Json& place = document_[Json::json_pointer(source.in_example)];
        const bool is_more = source.in_example.ends_with("/decorations") && place.is_array();
        if (source.in_example.ends_with("/shape") && place.is_object()) {
            faults_.add(source.in_file, source.who + ": another node is the shape of its object");
            return;
        }
        if (!is_more) {
            place = std::move(value);
            sources_.push_back(source);
            return;
        }
        if (!value.is_array()) {
            faults_.add(source.in_file, source.who + ": must be a list");
            return;
        }
        for (std::size_t i = 0; i < value.size(); ++i) {
            sources_.push_back(
                {source.in_example + "/" + std::to_string(place.size()),
                 source.in_file + "/" + std::to_string(i),
                 source.who}
            );
            place.push_back(std::move(value[i]));
        }
    }

    // The same at its place in the file: of all that it is in the innermost that was said last.
    [[nodiscard]] Fault in_file(Fault fault) const {
        std::optional<std::size_t> best;
        for (std::size_t i = 0; i < sources_.size(); ++i) {
            const std::string& place = sources_[i].in_example;
            const bool is_in =
                fault.pointer.starts_with(place) &&
                (fault.pointer.size() == place.size() || fault.pointer[place.size()] == '/');
            if (is_in && (!best || place.size() >= sources_[*best].in_example.size())) {
                best = i;
            }
        }
        if (!best) {
            fault.pointer.clear();
            return fault;
        }
        const Source& source = sources_[*best];
        // Nothing in a mesh has the place that it has in the example.
        const bool is_said = *best >= geometry_count_;
        fault.pointer =
            source.in_file + (is_said ? fault.pointer.substr(source.in_example.size()) : "");
        fault.detail = source.who + ": " + fault.detail;
        return fault;
    }

    const RequestLimits& limits_;
    ExtraWriter writer_;
    std::vector<Source> sources_;
    std::size_t geometry_count_ = 0;  // those of solids, which come first
    std::vector<SaidField> said_;
    Json document_;
    Faults faults_;
};

}  // namespace

Parsed<ExampleUpload> parse_example_glb(std::string_view bytes, const RequestLimits& limits) {
    auto imported = continuous::read_example_glb(std::as_bytes(std::span(bytes)));
    if (!imported) {
        Problem problem = problem_of(imported.error());
        if (imported.error().code == ErrorCode::kInvalidArgument) {
            problem.detail = "the example cannot be used: " + problem.detail;
        }
        return tl::unexpected(std::move(problem));
    }
    return GlbExample(std::move(*imported), limits).read();
}

}  // namespace modelsynth::proto
