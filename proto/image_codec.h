#pragma once

// Private to proto's sources.

#include "proto/json.h"
#include "proto/limits.h"
#include "solver/continuous/example.h"
#include "solver/mesh/texture.h"

#include <cstddef>
#include <memory>
#include <vector>

namespace modelsynth::proto {

using SharedImage = std::shared_ptr<const Image>;

// The images of an example: a list of data: URIs of PNGs and JPEGs. Equal ones are the same; null
// where there is a fault.
[[nodiscard]] std::vector<SharedImage> read_images(const Value& value, const RequestLimits& limits);

// The images that the materials of an example have, each once.
class ImageList {
  public:
    explicit ImageList(const continuous::Example& example);

    [[nodiscard]] bool empty() const { return images_.empty(); }

    // How many there are when it is none of them.
    [[nodiscard]] std::size_t number_of(const Texture& texture) const;

    [[nodiscard]] OrderedJson write() const;

  private:
    std::vector<const Image*> images_;
};

}  // namespace modelsynth::proto
