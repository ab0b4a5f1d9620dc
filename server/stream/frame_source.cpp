#include "server/stream/frame_source.h"

#include "solver/mesh/glb_writer.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace modelsynth::server {

using proto::FrameKind;
using proto::Partial;

namespace {

std::string patch_payload(const LiveJob& live, const Patch& patch, Partial partial) {
    if (partial == Partial::kLabels) {
        return proto::encode_labels(patch.labels);
    }
    // The region alone, in the whole model's frame.
    // Cells look the same whatever is around them; surfaces depend on it.
    std::vector<Label> labels(live.space().site_count(), kNoLabel);
    if (live.space().is_grid()) {
        live.space().copy_in(patch.labels, patch.region, labels);
    } else if (auto state = live.state_at(patch.seq)) {
        labels = std::move(state->model.labels);
    } else {
        return "";
    }
    return write_glb(live.space().make_scene(labels, patch.region)).value_or("");
}

// The frame alone, which keeps alive what it is part of.
template <class Made>
FrameSource::FramePointer frame_of(const std::shared_ptr<const Made>& made) {
    return {made, made->frame.get()};
}

}  // namespace

FrameSource::FramePointer FrameSource::block_frame(
    const std::string& job_id, std::uint64_t seq, Partial partial
) {
    const FrameKind kind = partial == Partial::kLabels ? FrameKind::kLabels : FrameKind::kGlb;
    const Key key = {job_id, kind, seq};
    if (const auto known = find(key)) {
        return frame_of(known);
    }
    const auto live = service_.live().find(job_id);
    const auto patch = live ? live->patch(seq) : nullptr;
    if (!patch) {
        return nullptr;
    }
    return frame_of(share(
        key,
        {std::make_shared<proto::Frame>(proto::Frame{
             kind, seq, patch->region, patch_payload(*live, *patch, partial)}),
         true}
    ));
}

FrameSource::FramePointer FrameSource::whole_frame(
    const std::string& job_id, std::uint64_t seq, Partial partial, WholeIf condition
) {
    const FrameKind kind =
        partial == Partial::kLabels ? FrameKind::kLabelsWhole : FrameKind::kGlbWhole;
    const Key key = {job_id, kind, seq};
    const auto is_wanted = [condition](bool any_block) {
        return any_block || condition == WholeIf::kAny;
    };
    if (const auto known = find(key)) {
        return is_wanted(known->any_block) ? frame_of(known) : nullptr;
    }
    const auto whole = service_.models().whole_state(job_id, seq);
    if (!whole || !is_wanted(whole->any_block)) {
        return nullptr;
    }
    const Model& model = whole->model;
    std::string payload = kind == FrameKind::kLabelsWhole
                              ? proto::encode_labels(model.labels)
                              : write_glb(whole_scene(model)).value_or("");
    return frame_of(share(
        key,
        {std::make_shared<proto::Frame>(proto::Frame{
             kind, whole->seq, Box::whole(model.space->size()), std::move(payload)}),
         whole->any_block}
    ));
}

std::shared_ptr<const FrameSource::Made> FrameSource::find(const Key& key) {
    const std::lock_guard lock(mutex_);
    const auto found = made_.find(key);
    return found == made_.end() ? nullptr : found->second.lock();
}

std::shared_ptr<const FrameSource::Made> FrameSource::share(const Key& key, Made made) {
    auto mine = std::make_shared<const Made>(std::move(made));
    const std::lock_guard lock(mutex_);
    if (made_.size() >= sweep_at_) {
        constexpr std::size_t kSweepMin = 256;
        std::erase_if(made_, [](const auto& entry) { return entry.second.expired(); });
        sweep_at_ = std::max(kSweepMin, 2 * made_.size());
    }
    std::weak_ptr<const Made>& kept = made_[key];
    if (auto other = kept.lock()) {
        return other;
    }
    kept = mine;
    return mine;
}

}  // namespace modelsynth::server
