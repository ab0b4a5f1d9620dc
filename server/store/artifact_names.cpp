#include "server/store/artifact_names.h"

namespace modelsynth::server {

namespace {

std::string numbered(const std::string& name, std::uint32_t alternative) {
    return alternative == 0 ? name : name + "." + std::to_string(alternative);
}

}  // namespace

std::string labels_artifact(std::uint32_t alternative) { return numbered("labels", alternative); }

std::string model_artifact(const std::string& form, std::uint32_t alternative) {
    return numbered(form + ".glb", alternative);
}

std::string gzipped_artifact(const std::string& name) { return name + ".gz"; }

}  // namespace modelsynth::server
