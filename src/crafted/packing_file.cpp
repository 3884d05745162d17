#include "contact/images.hpp"
#include "core/refuse.hpp"
#include "io/files.hpp"
#include "io/section.hpp"
#include "packing/bodies.hpp"
#include "packing/load_faults.hpp"
#include "packing/words.hpp"

#include <isostat/crafted/exact_packing.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

namespace isostat::crafted {

namespace {

class Reader {
  public:
    Reader(const std::string& text, const std::string& name)
        : lines_(text), name_(name), document_(parse_toml(text, name)), root_(&document_, "", name) {}

    PackingFile read() {
        constexpr const char* format = "isostat-packing 1";
        (void)root_.required("format", quoted(format));
        if (root_.string("format") != format) {
            root_.fail("format", quoted(format));
        }
        out_.packing.cell.dimension = root_.has("spheres") || root_.has("sphere") ? 3 : 2;
        out_.title = root_.string("title").value_or("");
        (void)root_.string("source");
        (void)root_.string("note");
        grains();
        cell();
        box();
        bodies();
        load();
        expected();
        root_.finish();
        return std::move(out_);
    }

  private:
    static std::string quoted(const char* word) { return fmt::format("\"{}\"", word); }
    [[nodiscard]] Section section(const std::string& key) { return {root_.table(key), key, name_}; }

    [[nodiscard]] Number number(const Section& in, const toml::node& node, const std::string& key) const {
        if (node.is_integer()) {
            return Number(static_cast<long long>(node.as_integer()->get()));
        }
        if (node.is_floating_point() || node.is_string()) {
            std::string text = node.is_string() ? node.as_string()->get() : lines_.slice(node.source());
            if (node.is_floating_point()) {
                std::erase(text, '_');
            }
            try {
                return Number::parse(text);
            } catch (const Error& error) {
                in.fail(node, key, "an exact number ({})", error.what());
            }
        }
        in.fail(node, key, "a number, or a string with an exact number");
    }

    [[nodiscard]] Number positive(const Section& in, const toml::node& node, const std::string& key) const {
        Number value = number(in, node, key);
        if (value.sign() <= 0) {
            in.fail(node, key, "a number above 0");
        }
        return value;
    }

    [[nodiscard]] int index(const Section& in, const toml::node& node, const std::string& key) const {
        const auto n = static_cast<std::int64_t>(out_.packing.radius.size());
        if (!node.is_integer() || node.as_integer()->get() < 0 || node.as_integer()->get() >= n) {
            in.fail(node, key, "the number of a {}, 0 to {}", grain(), n - 1);
        }
        return static_cast<int>(node.as_integer()->get());
    }

    /// Index of the axis or tilt that a word of `cell.moves` names; -1: no such name.
    template <class Names>
    [[nodiscard]] static int place(const Names& names, std::size_t count, std::string_view word) {
        const auto end = names.begin() + static_cast<std::ptrdiff_t>(count);
        const auto found = std::find(names.begin(), end, word);
        return found == end ? -1 : static_cast<int>(found - names.begin());
    }

    void add(PerAxis<Number> centre, Number r, bool fixed) {
        out_.packing.centre.push_back(std::move(centre));
        out_.packing.radius.push_back(std::move(r));
        out_.packing.fixed.push_back(fixed ? 1 : 0);
    }

    /// Reads the centres and radii: the short form, then the long form.
    void grains() {
        const std::string one = grain(), all = one + "s";
        const std::size_t d = out_.packing.axes();
        if (const toml::array* rows = root_.array(all)) {
            for (const toml::node& entry : *rows) {
                const toml::array& row = root_.array(entry, all, d + 1);
                PerAxis<Number> centre;
                for (std::size_t a = 0; a < d; ++a) {
                    centre[a] = number(root_, row[a], fmt::format("{}: {}", all, axis_names[a]));
                }
                add(std::move(centre), positive(root_, row[d], all + ": r"), false);
            }
        }
        if (const toml::array* rows = root_.array(one)) {
            for (const toml::node& entry : *rows) {
                Section row(&root_.table(entry, one), one, name_);
                PerAxis<Number> centre;
                for (std::size_t a = 0; a < d; ++a) {
                    centre[a] = number(row, row.required(axis_names[a], "a coordinate of the centre"), axis_names[a]);
                }
                Number r = positive(row, row.required("r", "a radius"), "r");
                add(std::move(centre), std::move(r), row.boolean("fixed").value_or(false));
                row.finish();
            }
        }
        if (out_.packing.radius.empty()) {
            throw Error(ErrorKind::bad_input,
                        name_ + ":1: no disk, expected \"disks\" or [[disk]], of spheres \"spheres\" or [[sphere]]");
        }
    }
    [[nodiscard]] std::string grain() const { return grain_word(out_.packing.dimension()); }

    /// Reads the tilts: one number in the plane, in space the numbers of xy, xz, yz. Where `may` is false the tilt is
    /// no coordinate, and 0 is `expected`.
    template <class May>
    [[nodiscard]] PerTilt<Number> tilts(const Section& in, const toml::node& node, May may,
                                        const char* expected) const {
        const std::size_t count = out_.packing.layout().tilts();
        PerTilt<Number> out;
        for (std::size_t t = 0; t < count; ++t) {
            const toml::node& entry = count == 1 ? node : in.array(node, "tilt", count)[t];
            out[t] = number(in, entry, "tilt");
            if (!out[t].is_zero() && !may(t)) {
                in.fail(entry, "tilt", expected);
            }
        }
        return out;
    }
    /// Whether both axes of a tilt are periodic.
    [[nodiscard]] bool leans(std::size_t tilt) const {
        const auto& periodic = out_.packing.cell.periodic;
        return periodic[tilt == 2 ? 1 : 0] && periodic[tilt == 0 ? 1 : 2];
    }

    [[nodiscard]] WallKind wall(const Section& in, const toml::node& node, const std::string& key, std::size_t axis,
                                bool may_move) const {
        const auto kind = value_of<WallKind>(node.value_or(std::string_view()), wall_kind_words);
        if (out_.packing.cell.periodic[axis] && kind != WallKind::absent) {
            in.fail(node, key, "\"absent\": {} repeats (period in [cell])", axis_names[axis]);
        }
        if (!kind || (!may_move && *kind == WallKind::movable)) {
            in.fail(node, key, may_move ? "\"absent\", \"fixed\" or \"movable\"" : "\"absent\" or \"fixed\"");
        }
        return *kind;
    }

    /// Reads which axes are periodic, and which coordinates of the cell move.
    void cell() {
        if (root_.table("cell") == nullptr) {
            return;
        }
        Section cell = section("cell");
        ExactPacking& packing = out_.packing;
        const toml::array& period =
            cell.array(cell.required("period", "a number or \"none\" for each axis"), "period", packing.axes());
        for (std::size_t a = 0; a < packing.axes(); ++a) {
            packing.cell.periodic[a] = !is_none(period[a]);
            if (packing.cell.periodic[a]) {
                packing.length[a] = positive(cell, period[a], "period");
            }
        }
        if (!packing.cell.any()) {
            cell.fail("period", "one period at least: a box has no [cell]");
        }
        if (const toml::node* tilt = cell.node("tilt")) {
            packing.tilt = tilts(
                cell, *tilt, [&](std::size_t t) { return leans(t); }, "0, as one axis does not repeat");
        }
        for (const toml::node& moved : cell.array(cell.required("moves", "the names of what moves"), "moves")) {
            moves(cell, moved);
        }
        if (const toml::node* pin = cell.node("pin")) {
            packing.cell.pin = index(cell, *pin, "pin");
        }
        if (std::ranges::find(packing.fixed, 1) != packing.fixed.end()) {
            cell.refuse("",
                        "a fixed {0} and a [cell]: expected no fixed {0} where an axis repeats: the pinned one says "
                        "where the origin is",
                        grain());
        }
        fits(cell, period);
        cell.finish();
    }

    void moves(const Section& in, const toml::node& moved) {
        Cell& cell = out_.packing.cell;
        const std::string_view word = moved.value_or(std::string_view());
        const int axis = place(axis_names, out_.packing.axes(), word);
        const int tilt = place(tilt_names, out_.packing.layout().tilts(), word);
        const auto at = static_cast<std::size_t>(std::max({axis, tilt, 0}));
        bool& flag = axis >= 0 ? cell.period_moves[at] : cell.tilt_moves[at];
        if (axis >= 0 ? !cell.periodic[at] || flag : tilt < 0 || !leans(at) || flag) {
            in.fail(moved, "moves",
                    out_.packing.dimension() == plane
                        ? "\"x\", \"y\" of an axis that repeats, or \"xy\" where both do, each once"
                        : "\"x\", \"y\", \"z\" of an axis that repeats, or \"xy\", \"xz\", \"yz\" where both do, each "
                          "once");
        }
        flag = true;
    }

    /// Checks that no disk is wider than a period vector, or so far away that its images would not be found.
    void fits(const Section& in, const toml::array& period) const {
        const ExactPacking& packing = out_.packing;
        for (std::size_t i = 0; i < packing.radius.size(); ++i) {
            const Number diameter = packing.radius[i] + packing.radius[i];
            for (std::size_t a = 0; a < packing.axes(); ++a) {
                const Number& length = packing.length[a];
                Number excess = length * length - diameter * diameter;
                for (std::size_t b = 0; b < a; ++b) {
                    const Number& lean = packing.tilt[Cell::tilt(b, a)];
                    excess += lean * lean;
                }
                if (packing.cell.periodic[a] && excess.sign() < 0) {
                    in.fail(
                        period[a], "period",
                        "a period vector at least as long as the diameter {} of {} {}, which overlaps its own image",
                        diameter.text(), grain(), i);
                }
            }
        }
        const Packing rounded = approximate(packing);
        validate(rounded, fmt::format("{}:{}", name_, period.source().begin.line));
        if (const auto beyond = disk_beyond(rounded, 0, farthest_disk)) {
            refuse(ErrorKind::bad_input, "{}:{}: {}", name_, period.source().begin.line, *beyond);
        }
    }

    static bool is_none(const toml::node& node) { return node.value_or(std::string_view()) == "none"; }

    void box() {
        if (root_.table("box") == nullptr) {
            return;
        }
        Section box = section("box");
        const std::size_t d = out_.packing.axes();
        for (std::size_t a = 0; a < d; ++a) {
            const bool repeats = out_.packing.cell.periodic[a];
            out_.packing.walls.lower[a] = repeats ? WallKind::absent : WallKind::fixed;
            out_.packing.walls.upper[a] = repeats ? WallKind::absent : WallKind::movable;
        }
        for (const char* side : {"lower", "upper"}) {
            if (const toml::array* kinds = box.array(side, d)) {
                const bool up = side == std::string_view("upper");
                for (std::size_t a = 0; a < d; ++a) {
                    (up ? out_.packing.walls.upper : out_.packing.walls.lower)[a] = wall(box, (*kinds)[a], side, a, up);
                }
            }
        }
        const auto& upper = out_.packing.walls.upper;
        const bool none = std::ranges::all_of(upper, [](WallKind w) { return w == WallKind::absent; });
        const toml::array* length = box.array("length", d);
        if (length == nullptr && !none) {
            (void)box.required("length", "the position of each upper wall");
        }
        for (std::size_t a = 0; length != nullptr && a < d; ++a) {
            if (upper[a] != WallKind::absent) {
                out_.packing.length[a] = positive(box, (*length)[a], "length");
            } else if (!is_none((*length)[a])) {
                box.fail((*length)[a], "length", "\"none\" for an absent wall");
            }
        }
        box.finish();
    }

    /// Reads the bars of the rigid bodies.
    void bodies() {
        const toml::array* bodies = root_.array("bodies");
        if (bodies == nullptr) {
            return;
        }
        ExactPacking& packing = out_.packing;
        std::vector<std::vector<int>> all;
        std::vector<unsigned char> taken = packing.fixed;
        for (const toml::node& body : *bodies) {
            all.emplace_back();
            for (const toml::node& member : root_.array(body, "bodies")) {
                const int i = all.back().emplace_back(index(root_, member, "bodies"));
                if (std::exchange(taken[static_cast<std::size_t>(i)], 1) != 0) {
                    root_.fail(member, "bodies", "a {} that is not fixed, once", grain());
                }
            }
            if (all.back().size() < 2) {
                root_.fail(body, "bodies", "two members or more");
            }
        }
        const std::string where = fmt::format("{}:{}", name_, root_.line_of("bodies"));
        packing.bars = bars_of_bodies(approximate(packing), all, where);
        const std::vector<Contact> list = with_bars({}, approximate(packing));
        if (exact::rank_bound(exact_contact_matrix(packing, DofMap(approximate(packing)), list)).rank <
            static_cast<int>(list.size())) {
            refuse(where, "the members of a body lie on one line, or in one plane: expected one more beside them, "
                          "inside another one");
        }
    }

    void load() {
        if (root_.table("load") == nullptr) {
            return;
        }
        Section load = section("load");
        const std::size_t d = out_.packing.axes();
        ExactLoad out;
        if (const toml::array* forces = load.array("wall", d)) {
            for (std::size_t a = 0; a < d; ++a) {
                out.wall[a] = number(load, (*forces)[a], "wall");
                if (!out.wall[a].is_zero() && out_.packing.walls.upper[a] != WallKind::movable &&
                    !out_.packing.cell.period_moves[a]) {
                    load.fail((*forces)[a], "wall",
                              out_.packing.cell.periodic[a] ? "0: the period along this axis does not move"
                                                            : "0: the upper wall of this axis is not movable");
                }
            }
        }
        if (const toml::node* tilt = load.node("tilt")) {
            out.tilt = tilts(
                load, *tilt, [&](std::size_t k) { return out_.packing.cell.tilt_moves[k]; },
                d == 2 ? "0: no tilt of a cell moves" : "0: this tilt of a cell does not move");
        }
        if (const toml::array* grains = load.array(grain())) {
            out.disk = grain_forces(load, *grains);
        }
        load.finish();
        out_.packing.load = std::move(out);
    }

    [[nodiscard]] std::vector<Number> grain_forces(const Section& in, const toml::array& rows) const {
        const std::size_t d = out_.packing.axes();
        std::vector<Number> out(d * out_.packing.radius.size());
        for (const toml::node& entry : rows) {
            const toml::array& row = in.array(entry, grain(), d + 1);
            const int i = index(in, row[0], grain());
            if (out_.packing.is_fixed(i)) {
                in.fail(row[0], grain(), "a {} that is not fixed", grain());
            }
            for (std::size_t a = 0; a < d; ++a) {
                out[out_.packing.layout().of_disk(i) + a] += number(in, row[a + 1], grain());
            }
        }
        if (const auto rest = unbalanced<Number>(out, out_.packing.cell)) {
            in.fail_found(rows, grain(), "forces that sum to " + rest->second.text(),
                          fmt::format("0 along {}, which repeats: the pinned {} would bear the rest",
                                      axis_names[rest->first], grain()));
        }
        return out;
    }

    /// A single value of `[expected]` as text: a string unchanged, a number exactly.
    [[nodiscard]] std::string word(const Section& in, const toml::node& node, const std::string& key) const {
        if (node.is_boolean()) {
            return node.as_boolean()->get() ? "true" : "false";
        }
        return node.is_string() ? node.as_string()->get() : number(in, node, key).text();
    }

    void expected() {
        const toml::table* table = root_.table("expected");
        if (table == nullptr) {
            return;
        }
        const Section in = section("expected");
        for (const auto& [key, value] : *table) {
            ExpectedEntry entry{std::string(key.str()), {}, static_cast<int>(key.source().begin.line)};
            if (!value.is_array()) {
                entry.values.push_back({word(in, value, entry.key)});
            } else {
                for (const toml::node& element : *value.as_array()) {
                    std::vector<std::string> row;
                    if (element.is_array()) {
                        for (const toml::node& part : *element.as_array()) {
                            row.push_back(word(in, part, entry.key));
                        }
                    } else {
                        row.push_back(word(in, element, entry.key));
                    }
                    entry.values.push_back(std::move(row));
                }
            }
            out_.expected.push_back(std::move(entry));
        }
    }

    TomlLines lines_;
    std::string name_;
    toml::table document_;
    Section root_;
    PackingFile out_;
};

} // namespace

PackingFile parse_packing(const std::string& text, const std::string& source) {
    return Reader(std::string(without_byte_order_mark(text)), source).read();
}

PackingFile read_packing(const std::string& path) {
    return parse_packing(read_text(path), path);
}

} // namespace isostat::crafted
