#pragma once

#include <cstdint>
#include <string>

namespace modelsynth::server {

// The names under which artifacts are linked to a job.

// What the job works on; linked when it is submitted:
// the text of an uploaded example (also linked with a model, which is drawn with it),
inline constexpr const char* kExampleArtifact = "example";
// and the labels of the model that the job starts from.
inline constexpr const char* kOriginArtifact = "origin";

// The labels of a model that was not finished, when the job ended.
inline constexpr const char* kPreviewArtifact = "preview";

// The labels of the job's model, and its file in a form: a profile ("nodes", "instanced",
// "merged"), or one with its compression ("nodes.meshopt"); where it has several, the first one's
// have the names that those of a single one would have.
[[nodiscard]] std::string labels_artifact(std::uint32_t alternative = 0);
[[nodiscard]] std::string model_artifact(const std::string& form, std::uint32_t alternative = 0);

// An artifact of that name, coded with gzip.
[[nodiscard]] std::string gzipped_artifact(const std::string& name);

}  // namespace modelsynth::server
