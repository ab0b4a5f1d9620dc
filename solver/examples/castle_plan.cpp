#include "solver/examples/castle_plan.h"

#include "solver/core/result.h"

#include <array>

namespace modelsynth::examples::castle {

namespace {

constexpr std::string_view kCurtainCells = "#123456G";
constexpr std::string_view kInnerCells = "=\"nu";
constexpr std::string_view kCourtCells = "_bws";
constexpr std::string_view kBodyCells = "AaBdKLMN";
constexpr std::string_view kKeepCells = "KLMN";

bool in(std::string_view set, char cell) { return set.find(cell) != std::string_view::npos; }

struct Place {
    int x = 0;
    int z = 0;
};

// East, north, west, south; what lies between one and the next is its diagonal.
constexpr std::array<Place, 4> kSteps = {{{1, 0}, {0, -1}, {-1, 0}, {0, 1}}};

Place neighbour(const Place& place, int side) {
    const Place& step = kSteps[static_cast<std::size_t>(side % 4)];
    return {place.x + step.x, place.z + step.z};
}

class Plan {
  public:
    Plan(const std::vector<std::string_view>& rows, std::size_t floor_count)
        : rows_(rows),
          depth_(static_cast<int>(rows.size())),
          width_(static_cast<int>(rows.front().size())),
          floors_(
              floor_count, std::vector<std::string>(rows.size(), std::string(rows[0].size(), kAir))
          ) {
        for (const std::string_view row : rows) {
            check(row.size() == rows.front().size(), "a row of the plan has another width");
        }
    }

    std::vector<std::vector<std::string>> build() {
        for (int z = 0; z < depth_; ++z) {
            for (int x = 0; x < width_; ++x) {
                stand({x, z});
            }
        }
        return std::move(floors_);
    }

  private:
    [[nodiscard]] bool inside_plan(const Place& p) const {
        return p.x >= 0 && p.x < width_ && p.z >= 0 && p.z < depth_;
    }

    // Beyond the plan lies meadow.
    [[nodiscard]] char at(const Place& p) const {
        return inside_plan(p) ? rows_[static_cast<std::size_t>(p.z)][static_cast<std::size_t>(p.x)]
                              : '.';
    }

    [[nodiscard]] bool is_court(const Place& p) const {
        return in(kCourtCells, at(p)) || in(kBodyCells, at(p)) || in(kInnerCells, at(p));
    }

    void require(bool condition, const Place& p, const char* why) const {
        check(
            condition,
            ("the castle's plan at column " + std::to_string(p.x) + ", row " + std::to_string(p.z) +
             ": " + why)
                .c_str()
        );
    }

    void put(const Place& p, std::size_t floor, char letter) {
        require(floor < floors_.size(), p, "higher than the plan's floors");
        floors_[floor][static_cast<std::size_t>(p.z)][static_cast<std::size_t>(p.x)] = letter;
    }

    // Whether a quality of the four neighbours holds, as a bit per side.
    template <class Quality>
    [[nodiscard]] unsigned sides(const Place& p, Quality quality) const {
        unsigned found = 0;
        for (int side = 0; side < 4; ++side) {
            found |= unsigned{quality(neighbour(p, side))} << side;
        }
        return found;
    }

    // The side from which `pattern`, given as seen from the east, fits; -1: from none.
    static int turns_to(unsigned pattern, unsigned found) {
        for (int turns = 0; turns < 4; ++turns) {
            if ((((pattern << turns) | (pattern >> (4 - turns))) & 0xFU) == found) {
                return turns;
            }
        }
        return -1;
    }

    void stand(const Place& p) {
        const char cell = at(p);
        if (in(kCurtainCells, cell)) {
            stand_curtain(p);
        } else if (in(kBodyCells, cell)) {
            stand_body(p);
        } else if (cell == 'p') {
            put(p, 0, path(p));
        } else if (cell == 'C') {
            put(p, 0, cottage(p));
        } else if (cell == 'f') {
            put(p, 0, field(p));
        } else {
            put(p, 0, ground(p));
        }
        // The piece on the ground reaches up there; what is not air is not taken for free.
        if (in("#GCtys", cell) || in(kInnerCells, cell)) {
            put(p, 1, letter_of(kUpper));
        }
    }

    // Open ground beside a wall is an edge; between two walls, of either. The edges are what keeps
    // walls apart.
    [[nodiscard]] char ground(const Place& p) const {
        const char cell = at(p);
        const int wall = wall_side(p);
        if (cell == '_' && wall < 0) {
            return court(p);
        }
        if (cell == 'o' || in(kInnerCells, cell) || wall < 0) {
            require(cell != 's', p, "a shed without a wall");
            return cell;
        }
        require(in("._s", cell), p, "only edges may lie beside walls");
        const Letter edge = cell == '.' ? kMeadowEdge : cell == '_' ? kCourtEdge : kShed;
        return letter_of(edge, wall + 2);
    }

    // On which side of open ground a wall stands, -1 for none. In a corner between walls it is
    // always the north or the south, so that an edge next to an edge tells how wide the ground is.
    [[nodiscard]] int wall_side(const Place& p) const {
        const unsigned walls = sides(p, [this](const Place& n) {
            return in(kCurtainCells, at(n)) || in(kInnerCells, at(n));
        });
        for (const int side : {1, 3, 0, 2}) {
            if ((walls >> side & 1U) != 0) {
                return side;
            }
        }
        return -1;
    }

    // Open court touches edges on one side of an axis only: no court is narrower than four cells.
    [[nodiscard]] char court(const Place& p) const {
        unsigned edges = 0;
        for (int side = 0; side < 4; ++side) {
            const Place n = neighbour(p, side);
            edges |= unsigned{in("_s", at(n)) && wall_side(n) == side} << side;
        }
        require((edges & 0b0101U) != 0b0101U && (edges & 0b1010U) != 0b1010U, p, "a narrow court");
        const bool east = (edges & 0b0101U) == 0 ? (p.x * 3 + p.z) % 2 == 0 : (edges & 1U) != 0;
        const bool south = (edges & 0b1010U) == 0 ? (p.x + p.z * 5) / 2 % 2 == 0 : edges >> 3U != 0;
        return letter_of(kCourt, south ? (east ? 2 : 1) : (east ? 3 : 0));
    }

    [[nodiscard]] char path(const Place& p) const {
        unsigned on =
            sides(p, [this](const Place& n) { return !inside_plan(n) || in("po", at(n)); });
        // At the rim of the plan a path runs straight out.
        if (turns_to(0b0101, on) < 0 && turns_to(0b0011, on) < 0) {
            on = sides(p, [this](const Place& n) { return in("po", at(n)); });
            const int only = turns_to(0b0001, on);
            require(only >= 0 && !inside_plan(neighbour(p, only + 2)), p, "a path with an end");
            on |= 1U << ((only + 2) % 4);
        }
        const int straight = turns_to(0b0101, on);
        return straight >= 0 ? letter_of(straight % 2 == 0 ? kPathX : kPathZ)
                             : letter_of(kPathBend, turns_to(0b0011, on));
    }

    [[nodiscard]] char cottage(const Place& p) const {
        const unsigned on = sides(p, [this](const Place& n) { return at(n) == 'C'; });
        const int middle = turns_to(0b0101, on);
        if (middle >= 0) {
            return letter_of(middle % 2 == 0 ? kCottageMiddleX : kCottageMiddleZ);
        }
        const int end = turns_to(0b0001, on);
        require(end >= 0, p, "cottages are rows of two cells and more");
        return letter_of(kCottage, end + 2);
    }

    [[nodiscard]] char field(const Place& p) const {
        const unsigned open = sides(p, [this](const Place& n) { return at(n) != 'f'; });
        const int corner = turns_to(0b0011, open);
        const int side = turns_to(0b0001, open);
        require(corner >= 0 || side >= 0, p, "fields are two cells wide");
        return corner >= 0 ? letter_of(kFieldCorner, corner) : letter_of(kFieldSide, side);
    }

    void stand_curtain(const Place& p) {
        const char cell = at(p);
        const unsigned arms = sides(p, [this](const Place& n) { return in(kCurtainCells, at(n)); });
        const unsigned court = sides(p, [this](const Place& n) { return is_court(n); });
        const unsigned meadow = 0xFU & ~arms & ~court;
        const bool turret = cell >= '1' && cell <= '6';
        int turns = turns_to(0b0001, meadow);
        if (turns >= 0) {
            require(turns_to(0b1010, arms) >= 0, p, "a curtain wall has an end");
            put(p, 0, letter_of(turret ? kTurret : cell == 'G' ? kGate : kCurtain, turns));
        } else if ((turns = turns_to(0b0011, meadow)) >= 0) {
            require(turns_to(0b1100, arms) == turns && cell != 'G', p, "no convex corner");
            put(p, 0, letter_of(turret ? kTurretConvex : kCurtainConvex, turns));
        } else {
            turns = turns_to(0b0011, arms);
            require(turns >= 0 && meadow == 0 && cell != 'G', p, "no concave corner");
            put(p, 0, letter_of(turret ? kTurretConcave : kCurtainConcave, turns));
        }
        if (turret) {
            static constexpr std::array<std::string_view, 6> kStacks = {
                "lM", "l^", "lv", "lIM", "lI^", "lIv"};
            std::size_t floor = 1;
            for (const char piece : kStacks[static_cast<std::size_t>(cell - '1')]) {
                put(p, floor++, piece);
            }
        }
    }

    // What a cell is in a body; a nook is an inside cell with the open at one of its corners.
    struct BodyPart {
        enum Kind : std::uint8_t { kCorner, kSide, kNook, kInner } kind;

        int turns;
    };

    // Whether a cell belongs to a body, `steps` cells in from its outline.
    [[nodiscard]] bool in_body(const Place& p, int steps) const {
        for (int dz = -steps; dz <= steps; ++dz) {
            for (int dx = -steps; dx <= steps; ++dx) {
                if (!in(kBodyCells, at({p.x + dx, p.z + dz}))) {
                    return false;
                }
            }
        }
        return true;
    }

    [[nodiscard]] BodyPart body_part(const Place& p, int steps) const {
        const unsigned open =
            sides(p, [this, steps](const Place& n) { return !in_body(n, steps); });
        if (const int side = turns_to(0b0001, open); side >= 0) {
            return {BodyPart::kSide, side};
        }
        if (const int corner = turns_to(0b0011, open); corner >= 0) {
            return {BodyPart::kCorner, corner};
        }
        require(open == 0, p, "a body is two cells wide at least");
        for (int turns = 0; turns < 4; ++turns) {
            if (!in_body(neighbour(neighbour(p, turns), turns + 1), steps)) {
                return {BodyPart::kNook, turns};
            }
        }
        return {BodyPart::kInner, 0};
    }

    void stand_body(const Place& p) {
        const char cell = at(p);
        const auto [kind, turns] = body_part(p, 0);
        const auto lay =
            [&, kind = kind, turns = turns](std::size_t floor, Letter corner, Letter side) {
                put(p,
                    floor,
                    kind == BodyPart::kCorner ? letter_of(corner, turns)
                    : kind == BodyPart::kSide ? letter_of(side, turns)
                                              : letter_of(kInside));
            };
        const bool door = in("ad", cell);
        require(!door || kind == BodyPart::kSide, p, "a door stands in a side");
        lay(0, kFootCorner, door ? kDoor : kFootSide);
        if (in(kKeepCells, cell)) {
            require(kind == BodyPart::kCorner, p, "a keep is two by two");
            const std::size_t shafts = cell == 'K' || cell == 'L' ? 2 : 3;
            for (std::size_t floor = 1; floor <= shafts; ++floor) {
                put(p, floor, letter_of(kKeepShaft, turns));
            }
            put(p, shafts + 1, letter_of(in("KM", cell) ? kKeepBattlement : kKeepSpire, turns));
            return;
        }
        std::size_t floor = 1;
        if (in("Bd", cell)) {
            lay(floor++, kStoreyCorner, kStoreySide);
        }
        // A roof goes up by slopes of one cell, each on the inside of the one below.
        for (int steps = 0; in_body(p, steps); ++steps) {
            const auto [part, turned] = body_part(p, steps);
            const bool chimney = part == BodyPart::kSide && turned == 3 && (p.x + p.z) % 3 == 0;
            put(p,
                floor++,
                part == BodyPart::kCorner ? letter_of(kRoofCorner, turned)
                : chimney                 ? letter_of(kChimney)
                : part == BodyPart::kSide ? letter_of(kRoofSide, turned)
                : part == BodyPart::kNook ? letter_of(kRoofValley, turned)
                                          : letter_of(kInside));
            if (part != BodyPart::kInner) {
                break;
            }
        }
    }

    const std::vector<std::string_view>& rows_;
    int depth_;
    int width_;
    std::vector<std::vector<std::string>> floors_;
};

// The plan's letters that say a direction, turned.
char turned_cell(char cell) {
    switch (cell) {
        case '=':
            return '"';
        case '"':
            return '=';
        case 'n':
            return 'u';
        case 'u':
            return 'n';
        default:
            return cell;
    }
}

}  // namespace

std::string letters_of(Letter first, int count) {
    std::string letters;
    for (int turns = 0; turns < count; ++turns) {
        letters += letter_of(first, turns);
    }
    return letters;
}

std::vector<std::vector<std::string>> build_plan(
    const std::vector<std::string_view>& rows, std::size_t floor_count
) {
    return Plan(rows, floor_count).build();
}

std::vector<std::string> in_four_turns(const std::vector<std::string_view>& rows) {
    const std::size_t size = rows.size();
    std::vector<std::string> whole(2 * size, std::string(2 * size, '.'));
    const std::size_t last = 2 * size - 1;
    for (std::size_t z = 0; z < size; ++z) {
        check(rows[z].size() == size, "a plan that is turned must be square");
        for (std::size_t x = 0; x < size; ++x) {
            const char cell = rows[z][x];
            whole[z][x] = cell;
            whole[x][last - z] = turned_cell(cell);
            whole[last - z][last - x] = cell;
            whole[last - x][z] = turned_cell(cell);
        }
    }
    return whole;
}

}  // namespace modelsynth::examples::castle
