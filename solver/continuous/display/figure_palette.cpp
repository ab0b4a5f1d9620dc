#include "solver/continuous/display/figure_palette.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace modelsynth::continuous {

namespace {

using Shade = std::array<double, 3>;

// The sides of the cube, two for each axis, and how bright they are: the lower one is dark, or one
// would take it for a floor.
constexpr std::array<const char*, 6> kSideNames = {
    "west", "east", "bottom", "top", "back", "front"};
constexpr std::array<double, 6> kSideLight = {0.9, 0.84, 0.66, 1, 0.8, 0.93};

// Hatches of objects whose numbers follow each other lie apart.
constexpr std::array<int, 6> kHatchDegrees = {45, 135, 75, 165, 15, 105};

Shade mixed(const Shade& a, const Shade& b, double share_of_b) {
    Shade mix = {};
    for (std::size_t part = 0; part < 3; ++part) {
        mix[part] = a[part] + (b[part] - a[part]) * share_of_b;
    }
    return mix;
}

Shade lit(const Shade& shade, double light) { return mixed({0, 0, 0}, shade, light); }

double distance(const Shade& a, const Shade& b) {
    double sum = 0;
    for (std::size_t part = 0; part < 3; ++part) {
        sum += (a[part] - b[part]) * (a[part] - b[part]);
    }
    return std::sqrt(sum);
}

double encoded(float linear) {
    const double value = std::clamp(static_cast<double>(linear), 0.0, 1.0);
    return value <= 0.0031308 ? 12.92 * value : 1.055 * std::pow(value, 1 / 2.4) - 0.055;
}

std::string hex(const Shade& shade) {
    constexpr const char* kDigits = "0123456789abcdef";
    std::string text = "#";
    for (const double part : shade) {
        const auto byte = static_cast<std::size_t>(std::lround(std::clamp(part, 0.0, 1.0) * 255));
        text += kDigits[byte / 16];
        text += kDigits[byte % 16];
    }
    return text;
}

// The shade itself where it differs from all others; else the first mix with another colour that
// does, or the one that differs most.
Shade distinct(const Shade& wanted, const std::vector<Shade>& others) {
    constexpr double kApart = 0.16;
    constexpr std::array<Shade, 8> kTowards = {
        {{0.15, 0.15, 0.2},
         {1, 1, 0.95},
         {0.85, 0.45, 0.1},
         {0.1, 0.4, 0.75},
         {0.2, 0.6, 0.25},
         {0.7, 0.2, 0.5},
         {0.9, 0.8, 0.2},
         {0.1, 0.65, 0.65}}};
    const auto nearest = [&others](const Shade& shade) {
        double least = 9;
        for (std::size_t i = 1; i < others.size(); ++i) {
            least = std::min(least, distance(shade, others[i]));
        }
        return least;
    };
    Shade best = wanted;
    for (const double share : {0.0, 0.3, 0.5, 0.7}) {
        for (const Shade& towards : kTowards) {
            const Shade next = mixed(wanted, towards, share);
            if (nearest(next) > nearest(best)) {
                best = next;
            }
            if (nearest(best) >= kApart) {
                return best;
            }
        }
    }
    return best;
}

std::size_t side_of(const Point& normal) {
    Eigen::Index axis = 0;
    static_cast<void>(normal.cwiseAbs().maxCoeff(&axis));
    return 2 * static_cast<std::size_t>(axis) + (normal[axis] > 0 ? 1 : 0);
}

std::string pattern_name(ObjectId object, std::size_t side) {
    return std::string("cut-") + kSideNames[side] + "-" + std::to_string(object);
}

}  // namespace

FigurePalette::FigurePalette(const Example& example) {
    shades_.push_back({});
    for (const ObjectType& object : example.objects) {
        const Color& color = example.materials[object.material].base_color;
        shades_.push_back(distinct({encoded(color.r), encoded(color.g), encoded(color.b)}, shades_)
        );
    }
}

std::string FigurePalette::plain(ObjectId object) const { return hex(shades_[object]); }

std::string FigurePalette::surface(ObjectId object, const Point& normal) const {
    const double towards = normal.dot(Point(-0.35, 0.8, 0.487));
    return hex(lit(shades_[object], 0.7 + 0.3 * towards));
}

std::string FigurePalette::cut(ObjectId object, const Point& normal) {
    const std::size_t side = side_of(normal);
    used_.emplace(object, side);
    return "url(#" + pattern_name(object, side) + ")";
}

std::string FigurePalette::patterns() const {
    std::string svg;
    for (const auto& [object, side] : used_) {
        const Shade pale = mixed(shades_[object], {1, 1, 1}, 0.62);
        svg += "<pattern id=\"" + pattern_name(object, side) +
               "\" width=\"4\" height=\"4\" patternUnits=\"userSpaceOnUse\" "
               "patternTransform=\"rotate(" +
               std::to_string(kHatchDegrees[object % kHatchDegrees.size()]) + ")\"><path fill=\"" +
               hex(lit(pale, kSideLight[side])) + "\" d=\"M0 0h4v4h-4z\"/><path stroke=\"" +
               hex(lit(shades_[object], 0.8)) +
               "\" stroke-width=\"0.8\" d=\"M2 0v4\"/></pattern>\n";
    }
    return svg;
}

}  // namespace modelsynth::continuous
