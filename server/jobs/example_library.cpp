#include "server/jobs/example_library.h"

#include "proto/example_codec.h"
#include "server/jobs/store_problem.h"
#include "solver/examples/all.h"

#include <algorithm>
#include <utility>

namespace modelsynth::server {

namespace {

std::optional<ExampleLibrary::Entry> find_built_in(const std::string& id) {
    auto example = examples::find(id);
    return example ? std::optional(ExampleLibrary::Entry{id, true, std::move(*example)})
                   : std::nullopt;
}

}  // namespace

ExampleLibrary::ExampleLibrary(
    ExampleStore& store,
    ArtifactStore& artifacts,
    const proto::RequestLimits& limits,
    std::size_t uploads_max
)
    : store_(store), artifacts_(artifacts), limits_(limits), uploads_max_(uploads_max) {}

std::optional<ExampleLibrary::Entry> ExampleLibrary::find(
    const std::string& id, const Caller& caller
) {
    if (auto built_in = find_built_in(id)) {
        return built_in;
    }
    const auto row = store_.find_example(id, caller.filter());
    if (!row) {
        return std::nullopt;
    }
    {
        const std::lock_guard lock(mutex_);
        const auto known = std::find_if(parsed_.begin(), parsed_.end(), [&id](const Entry& entry) {
            return entry.id == id;
        });
        if (known != parsed_.end()) {
            parsed_.splice(parsed_.begin(), parsed_, known);
            return parsed_.front();
        }
    }
    auto example = load(row->digest);
    if (!example) {
        return std::nullopt;
    }
    Entry entry = {id, false, std::move(*example), row->digest};
    remember(entry);
    return entry;
}

std::string ExampleLibrary::id_of(const std::string& digest) { return "x" + digest.substr(0, 24); }

std::optional<Example> ExampleLibrary::load(const std::string& digest) {
    const auto text = artifacts_.load(digest);
    if (!text) {
        return std::nullopt;
    }
    auto upload = proto::parse_example(*text, limits_);
    return upload ? std::optional<Example>(std::move(upload->example)) : std::nullopt;
}

proto::Parsed<std::vector<ExampleLibrary::Entry>> ExampleLibrary::list(const Caller& caller) {
    std::vector<Entry> entries;
    for (const Example& example : examples::all()) {
        entries.push_back({std::string(name_of(example)), true, example});
    }
    const auto rows = store_.list_examples(caller.filter());
    if (!rows) {
        return tl::unexpected(problem_of(rows.error()));
    }
    for (const auto& row : *rows) {
        if (auto entry = find(row.id, caller)) {
            entries.push_back(std::move(*entry));
        }
    }
    return entries;
}

proto::Parsed<ExampleLibrary::Entry> ExampleLibrary::upload(
    std::string_view body, Form form, const Caller& caller
) {
    auto upload = form == Form::kGlb ? proto::parse_example_glb(body, limits_)
                                     : proto::parse_example(body, limits_);
    if (!upload) {
        return tl::unexpected(std::move(upload.error()));
    }
    const auto pin = artifacts_.put(upload->canonical);
    if (!pin) {
        return tl::unexpected(problem_of(pin.error()));
    }
    const std::string& digest = (*pin)->digest();
    Entry entry = {id_of(digest), false, upload->example, digest};
    const auto kept = store_.add_example(
        {entry.id, std::string(name_of(upload->example)), digest}, caller.owner, uploads_max_
    );
    if (!kept) {
        if (kept.error().code == StoreErrorCode::kQueueFull) {
            return tl::unexpected(proto::make_problem("too-large", kept.error().message));
        }
        return tl::unexpected(problem_of(kept.error()));
    }
    remember(entry);
    return entry;
}

proto::Parsed<void> ExampleLibrary::erase(const std::string& id, const Caller& caller) {
    if (find_built_in(id)) {
        return tl::unexpected(
            proto::make_problem("forbidden", "built-in examples cannot be deleted")
        );
    }
    const auto erased = store_.erase_example(id, caller.filter());
    if (!erased && erased.error().code == StoreErrorCode::kConflict) {
        return tl::unexpected(proto::make_problem("example-in-use", erased.error().message));
    }
    if (!erased) {
        return tl::unexpected(problem_of(erased.error()));
    }
    const std::lock_guard lock(mutex_);
    parsed_.remove_if([&id](const Entry& entry) { return entry.id == id; });
    return {};
}

void ExampleLibrary::remember(const Entry& entry) {
    const std::lock_guard lock(mutex_);
    parsed_.remove_if([&entry](const Entry& known) { return known.id == entry.id; });
    parsed_.push_front(entry);
    if (parsed_.size() > kParsedMax) {
        parsed_.pop_back();
    }
}

}  // namespace modelsynth::server
