#pragma once

#include <cstddef>
#include <string>

namespace modelsynth::continuous {

class ExampleReading;

// Figures of an example as SVG drawings: what stands within a small cube around a point, seen from
// the front and above, and from behind and below. Surfaces have the colours of their objects,
// shaded by their slope; where the cube cuts through an object it is pale and hatched; edges that
// something hides are dashed. Objects whose colours are nearly the same get different ones.
// Captions say what object is where, as a Boolean expression (see expressions.h). Files that need
// no others: no script, no font, no address to load from. They suit light and dark pages, as the
// reader's browser prefers. Requires: names in UTF-8; markup in them is escaped. Ensures:
// well-formed XML, equal for equal examples on any machine. Thread-safe.

// One figure, by its number (its label), with what the half-spaces of its expressions are.
// Requires: there is one of that number (checked).
// Cost:     a millisecond, and a few kilobytes; more where it has very many planes.
[[nodiscard]] std::string draw_figure(const ExampleReading& reading, std::size_t number);

// Figures as a table: corners, edges, faces, and the insides of objects, each by number; the first
// kFiguresOnSheetMax of them, fewer where they have very many planes, and how many there are is
// said above. Cost:     some tenths of a second at most; a built-in example some hundredths, and a
// megabyte.
inline constexpr std::size_t kFiguresOnSheetMax = 256;
[[nodiscard]] std::string draw_figure_sheet(const ExampleReading& reading);

}  // namespace modelsynth::continuous
