#include "contact/images.hpp"
#include "io/files.hpp"
#include "io/toml.hpp"
#include "packing/bodies.hpp"
#include "packing/load_faults.hpp"
#include "packing/words.hpp"

#include <isostat/core/error.hpp>
#include <isostat/crafted/exact_packing.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <sstream>
#include <string_view>
#include <utility>

namespace isostat::crafted {

namespace {

/// The lines of a document, numbered as in toml++: line and column from 1, columns in code points.
class Source {
  public:
    explicit Source(const std::string& text) {
        std::istringstream stream(text);
        for (std::string line; std::getline(stream, line);) {
            lines_.push_back(line);
        }
    }
    /// The text of a region within one line.
    [[nodiscard]] std::string slice(const toml::source_region& region) const {
        if (region.begin.line == 0 || region.begin.line > lines_.size() || region.end.line != region.begin.line) {
            return {};
        }
        const std::string& line = lines_[region.begin.line - 1];
        const std::size_t begin = offset(line, region.begin.column);
        return line.substr(begin, offset(line, region.end.column) - begin);
    }

  private:
    static std::size_t offset(const std::string& line, std::size_t column) {
        std::size_t at = 0;
        for (std::size_t k = 1; k < column && at < line.size(); ++k) {
            do {
                ++at;
            } while (at < line.size() && (static_cast<unsigned char>(line[at]) & 0xC0u) == 0x80u);
        }
        return at;
    }
    std::vector<std::string> lines_;
};

class Reader {
  public:
    Reader(const std::string& text, const std::string& name)
        : source_(text), name_(name), root_(parse_toml(text, name)) {}

    PackingFile read() {
        const bool space = root_.contains("spheres") || root_.contains("sphere");
        out_.packing.cell.dimension = space ? 3 : 2;
        allow(root_, "",
              {"format", "title", "source", "note", space ? "spheres" : "disks", grain_word(space ? 3 : 2), "bodies",
               "box", "cell", "load", "expected"});
        const std::string format = string(required(root_, "format"), "format");
        if (format != "isostat-packing 1") {
            fail(*root_.get("format"), "format", "\"" + format + "\"", "\"isostat-packing 1\"");
        }
        for (const char* key : {"title", "source", "note"}) {
            if (const toml::node* node = root_.get(key)) {
                const std::string value = string(*node, key);
                out_.title = std::string_view(key) == "title" ? value : out_.title;
            }
        }
        grains();
        cell();
        box();
        bodies();
        load();
        expected();
        return std::move(out_);
    }

  private:
    [[noreturn]] void fail(const toml::node& node, const std::string& key, const std::string& found,
                           const std::string& wanted) const {
        throw Error(ErrorKind::bad_input, name_ + ":" + std::to_string(node.source().begin.line) + ": " + key + " = " +
                                              found + ", expected " + wanted);
    }

    static std::string type_name(const toml::node& node) {
        std::ostringstream out;
        out << "a value of type " << node.type();
        return out.str();
    }

    void allow(const toml::table& table, const std::string& where, const std::vector<std::string_view>& keys) const {
        for (const auto& [key, node] : table) {
            if (std::find(keys.begin(), keys.end(), key.str()) == keys.end()) {
                throw Error(ErrorKind::bad_input,
                            fmt::format("{}:{}: unknown key \"{}{}\", expected one of {}", name_,
                                        key.source().begin.line, where, key.str(), fmt::join(keys, ", ")));
            }
        }
    }

    [[nodiscard]] const toml::node& required(const toml::table& table, const std::string& key,
                                             const std::string& where = "") const {
        const toml::node* node = table.get(key);
        if (node == nullptr) {
            throw Error(ErrorKind::bad_input, name_ + ":" + std::to_string(std::max(table.source().begin.line, 1u)) +
                                                  ": key \"" + where + key + "\" is missing");
        }
        return *node;
    }

    /// The value of a node as one type; `wanted` describes this type.
    template <class Value>
    [[nodiscard]] const auto& typed(const toml::node& node, const std::string& key, const char* wanted) const {
        const auto* value = node.as<Value>();
        if (value == nullptr) {
            fail(node, key, type_name(node), wanted);
        }
        return *value;
    }
    [[nodiscard]] const toml::table& table(const toml::node& node, const std::string& key) const {
        return typed<toml::table>(node, key, "a table");
    }
    [[nodiscard]] std::string string(const toml::node& node, const std::string& key) const {
        return typed<std::string>(node, key, "a string").get();
    }
    [[nodiscard]] bool boolean(const toml::node& node, const std::string& key) const {
        return typed<bool>(node, key, "true or false").get();
    }

    [[nodiscard]] const toml::array& array(const toml::node& node, const std::string& key, std::size_t size = 0) const {
        const toml::array& out = typed<toml::array>(node, key, "an array");
        if (size != 0 && out.size() != size) {
            fail(node, key, "an array of " + std::to_string(out.size()), "an array of " + std::to_string(size));
        }
        return out;
    }

    [[nodiscard]] Number number(const toml::node& node, const std::string& key) const {
        if (node.is_integer()) {
            return Number(static_cast<long long>(node.as_integer()->get()));
        }
        if (node.is_floating_point() || node.is_string()) {
            std::string text = node.is_string() ? node.as_string()->get() : source_.slice(node.source());
            if (node.is_floating_point()) {
                std::erase(text, '_');
            }
            try {
                return Number::parse(text);
            } catch (const Error& error) {
                fail(node, key, "\"" + text.substr(0, 80) + "\"",
                     std::string("an exact number (") + error.what() + ")");
            }
        }
        fail(node, key, type_name(node), "a number, or a string with an exact number");
    }

    [[nodiscard]] Number positive(const toml::node& node, const std::string& key) const {
        Number value = number(node, key);
        if (value.sign() <= 0) {
            fail(node, key, value.text(), "a number above 0");
        }
        return value;
    }

    [[nodiscard]] int index(const toml::node& node, const std::string& key) const {
        const auto n = static_cast<std::int64_t>(out_.packing.radius.size());
        if (!node.is_integer() || node.as_integer()->get() < 0 || node.as_integer()->get() >= n) {
            fail(node, key, node.is_integer() ? std::to_string(node.as_integer()->get()) : type_name(node),
                 fmt::format("the number of a {}, 0 to {}", grain(), n - 1));
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
        if (const toml::node* node = root_.get(all)) {
            for (const toml::node& entry : array(*node, all)) {
                const toml::array& row = array(entry, all, d + 1);
                PerAxis<Number> centre;
                for (std::size_t a = 0; a < d; ++a) {
                    centre[a] = number(row[a], fmt::format("{}: {}", all, axis_names[a]));
                }
                add(std::move(centre), positive(row[d], all + ": r"), false);
            }
        }
        if (const toml::node* node = root_.get(one)) {
            for (const toml::node& entry : array(*node, one)) {
                const toml::table& row = table(entry, one);
                std::vector<std::string_view> keys(axis_names.begin(), axis_names.begin() + static_cast<long>(d));
                keys.insert(keys.end(), {"r", "fixed"});
                allow(row, one + ".", keys);
                PerAxis<Number> centre;
                for (std::size_t a = 0; a < d; ++a) {
                    centre[a] = number(required(row, axis_names[a], one + "."), one + "." + axis_names[a]);
                }
                const toml::node* fixed = row.get("fixed");
                add(std::move(centre), positive(required(row, "r", one + "."), one + ".r"),
                    fixed != nullptr && boolean(*fixed, one + ".fixed"));
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
    [[nodiscard]] PerTilt<Number> tilts(const toml::node& node, const std::string& key, May may,
                                        const char* expected) const {
        const std::size_t count = out_.packing.layout().tilts();
        PerTilt<Number> out;
        for (std::size_t t = 0; t < count; ++t) {
            const toml::node& entry = count == 1 ? node : array(node, key, count)[t];
            out[t] = number(entry, key);
            if (!out[t].is_zero() && !may(t)) {
                fail(entry, key, out[t].text(), expected);
            }
        }
        return out;
    }
    /// Whether both axes of a tilt are periodic.
    [[nodiscard]] bool leans(std::size_t tilt) const {
        const auto& periodic = out_.packing.cell.periodic;
        return periodic[tilt == 2 ? 1 : 0] && periodic[tilt == 0 ? 1 : 2];
    }

    [[nodiscard]] WallKind wall(const toml::node& node, const std::string& key, std::size_t axis, bool may_move) const {
        const std::string kind = string(node, key);
        if (kind != "absent" && out_.packing.cell.periodic[axis]) {
            fail(node, key, "\"" + kind + "\"", fmt::format("\"absent\": {} repeats (cell.period)", axis_names[axis]));
        }
        if (const auto known = value_of<WallKind>(kind, wall_kind_words);
            known && (may_move || *known != WallKind::movable)) {
            return *known;
        }
        fail(node, key, "\"" + kind + "\"",
             may_move ? "\"absent\", \"fixed\" or \"movable\"" : "\"absent\" or \"fixed\"");
    }

    /// Reads which axes are periodic, and which coordinates of the cell move.
    void cell() {
        const toml::node* node = root_.get("cell");
        if (node == nullptr) {
            return;
        }
        const toml::table& cell = table(*node, "cell");
        allow(cell, "cell.", {"period", "tilt", "moves", "pin"});
        ExactPacking& packing = out_.packing;
        const toml::array& period = array(required(cell, "period", "cell."), "cell.period", packing.axes());
        for (std::size_t a = 0; a < packing.axes(); ++a) {
            packing.cell.periodic[a] = !(period[a].is_string() && period[a].as_string()->get() == "none");
            if (packing.cell.periodic[a]) {
                packing.length[a] = positive(period[a], "cell.period");
            }
        }
        if (!packing.cell.any()) {
            fail(period, "cell.period", "\"none\" along every axis", "one period at least: a box has no [cell]");
        }
        if (const toml::node* tilt = cell.get("tilt")) {
            packing.tilt = tilts(
                *tilt, "cell.tilt", [&](std::size_t t) { return leans(t); }, "0, as one axis does not repeat");
        }
        for (const toml::node& moved : array(required(cell, "moves", "cell."), "cell.moves")) {
            moves(moved);
        }
        if (const toml::node* pin = cell.get("pin")) {
            packing.cell.pin = index(*pin, "cell.pin");
        }
        if (std::find(packing.fixed.begin(), packing.fixed.end(), 1) != packing.fixed.end()) {
            fail(*node, grain() + ".fixed", "true",
                 fmt::format("no fixed {} where an axis repeats: the pinned one says where the origin is", grain()));
        }
        fits(period);
    }

    void moves(const toml::node& moved) {
        Cell& cell = out_.packing.cell;
        const std::string word = string(moved, "cell.moves");
        const int axis = place(axis_names, out_.packing.axes(), word);
        const int tilt = place(tilt_names, out_.packing.layout().tilts(), word);
        const auto at = static_cast<std::size_t>(std::max({axis, tilt, 0}));
        bool& flag = axis >= 0 ? cell.period_moves[at] : cell.tilt_moves[at];
        if (axis >= 0 ? !cell.periodic[at] || flag : tilt < 0 || !leans(at) || flag) {
            fail(moved, "cell.moves", "\"" + word + "\"",
                 out_.packing.dimension() == plane
                     ? "\"x\", \"y\" of an axis that repeats, or \"xy\" where both do, each once"
                     : "\"x\", \"y\", \"z\" of an axis that repeats, or \"xy\", \"xz\", \"yz\" where both do, each "
                       "once");
        }
        flag = true;
    }

    /// Checks that no disk is wider than a period vector, or so far away that its images would not be found.
    void fits(const toml::array& period) const {
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
                    fail(period[a], "cell.period", length.text(),
                         fmt::format("a period vector at least as long as the diameter {} of {} {}, which overlaps "
                                     "its own image",
                                     diameter.text(), grain(), i));
                }
            }
        }
        const Packing rounded = approximate(packing);
        validate(rounded, fmt::format("{}:{}", name_, period.source().begin.line));
        if (const auto beyond = disk_beyond(rounded, 0, farthest_disk)) {
            throw Error(ErrorKind::bad_input, fmt::format("{}:{}: {}", name_, period.source().begin.line, *beyond));
        }
    }

    void box() {
        const toml::node* node = root_.get("box");
        if (node == nullptr) {
            return;
        }
        const toml::table& box = table(*node, "box");
        allow(box, "box.", {"length", "lower", "upper"});
        const std::size_t d = out_.packing.axes();
        for (std::size_t a = 0; a < d; ++a) {
            const bool repeats = out_.packing.cell.periodic[a];
            out_.packing.walls.lower[a] = repeats ? WallKind::absent : WallKind::fixed;
            out_.packing.walls.upper[a] = repeats ? WallKind::absent : WallKind::movable;
        }
        for (const char* side : {"lower", "upper"}) {
            if (const toml::node* given = box.get(side)) {
                const bool up = side == std::string_view("upper");
                const std::string key = std::string("box.") + side;
                const toml::array& kinds = array(*given, key, d);
                for (std::size_t a = 0; a < d; ++a) {
                    (up ? out_.packing.walls.upper : out_.packing.walls.lower)[a] = wall(kinds[a], key, a, up);
                }
            }
        }
        const auto& upper = out_.packing.walls.upper;
        const bool none = std::all_of(upper.begin(), upper.end(), [](WallKind w) { return w == WallKind::absent; });
        if (none && box.get("length") == nullptr) {
            return;
        }
        const toml::array& length = array(required(box, "length", "box."), "box.length", d);
        for (std::size_t a = 0; a < d; ++a) {
            if (upper[a] != WallKind::absent) {
                out_.packing.length[a] = positive(length[a], "box.length");
            } else if (!length[a].is_string() || length[a].as_string()->get() != "none") {
                fail(length[a], "box.length", "a value", "\"none\" for an absent wall");
            }
        }
    }

    /// Reads the bars of the rigid bodies.
    void bodies() {
        const toml::node* node = root_.get("bodies");
        if (node == nullptr) {
            return;
        }
        ExactPacking& packing = out_.packing;
        std::vector<std::vector<int>> all;
        std::vector<unsigned char> taken = packing.fixed;
        for (const toml::node& body : array(*node, "bodies")) {
            all.emplace_back();
            for (const toml::node& member : array(body, "bodies")) {
                const int i = all.back().emplace_back(index(member, "bodies"));
                if (std::exchange(taken[static_cast<std::size_t>(i)], 1) != 0) {
                    fail(member, "bodies", std::to_string(i), fmt::format("a {} that is not fixed, once", grain()));
                }
            }
            if (all.back().size() < 2) {
                fail(body, "bodies", "one member or none", "two members or more");
            }
        }
        const std::string where = fmt::format("{}:{}", name_, node->source().begin.line);
        packing.bars = bars_of_bodies(approximate(packing), all, where);
        std::vector<Contact> list;
        for (const Bar& bar : packing.bars) {
            list.emplace_back(ContactKind::bar, bar.i, bar.j);
        }
        if (exact::rank_bound(exact_contact_matrix(packing, DofMap(approximate(packing)), list)).rank <
            static_cast<int>(list.size())) {
            throw Error(ErrorKind::bad_input, where +
                                                  ": the members of a body lie on one line, or in one plane: expected "
                                                  "one more beside them, inside another one");
        }
    }

    void load() {
        const toml::node* node = root_.get("load");
        if (node == nullptr) {
            return;
        }
        const toml::table& load = table(*node, "load");
        allow(load, "load.", {"wall", "tilt", grain_word(out_.packing.dimension())});
        const std::size_t d = out_.packing.axes();
        ExactLoad out;
        if (const toml::node* walls = load.get("wall")) {
            const toml::array& forces = array(*walls, "load.wall", d);
            for (std::size_t a = 0; a < d; ++a) {
                out.wall[a] = number(forces[a], "load.wall");
                if (!out.wall[a].is_zero() && out_.packing.walls.upper[a] != WallKind::movable &&
                    !out_.packing.cell.period_moves[a]) {
                    fail(forces[a], "load.wall", out.wall[a].text(),
                         out_.packing.cell.periodic[a] ? "0: the period along this axis does not move"
                                                       : "0: the upper wall of this axis is not movable");
                }
            }
        }
        if (const toml::node* tilt = load.get("tilt")) {
            out.tilt = tilts(
                *tilt, "load.tilt", [&](std::size_t k) { return out_.packing.cell.tilt_moves[k]; },
                d == 2 ? "0: no tilt of a cell moves" : "0: this tilt of a cell does not move");
        }
        if (const toml::node* disks = load.get(grain())) {
            out.disk = grain_forces(*disks);
        }
        out_.packing.load = std::move(out);
    }

    [[nodiscard]] std::vector<Number> grain_forces(const toml::node& node) const {
        const std::size_t d = out_.packing.axes();
        const std::string key = "load." + grain();
        std::vector<Number> out(d * out_.packing.radius.size());
        for (const toml::node& entry : array(node, key)) {
            const toml::array& row = array(entry, key, d + 1);
            const int i = index(row[0], key);
            if (out_.packing.is_fixed(i)) {
                fail(row[0], key, std::to_string(i), fmt::format("a {} that is not fixed", grain()));
            }
            for (std::size_t a = 0; a < d; ++a) {
                out[out_.packing.layout().of_disk(i) + a] += number(row[a + 1], key);
            }
        }
        if (const auto rest = unbalanced<Number>(out, out_.packing.cell)) {
            fail(node, key, "forces that sum to " + rest->second.text(),
                 fmt::format("0 along {}, which repeats: the pinned {} would bear the rest", axis_names[rest->first],
                             grain()));
        }
        return out;
    }

    /// A single value of `[expected]` as text: a string unchanged, a number exactly.
    [[nodiscard]] std::string word(const toml::node& node, const std::string& key) const {
        if (node.is_boolean()) {
            return boolean(node, key) ? "true" : "false";
        }
        return node.is_string() ? string(node, key) : number(node, key).text();
    }

    void expected() {
        const toml::node* node = root_.get("expected");
        if (node == nullptr) {
            return;
        }
        for (const auto& [key, value] : table(*node, "expected")) {
            const std::string name = "expected." + std::string(key.str());
            ExpectedEntry entry{std::string(key.str()), {}, static_cast<int>(key.source().begin.line)};
            if (!value.is_array()) {
                entry.values.push_back({word(value, name)});
            } else {
                for (const toml::node& element : *value.as_array()) {
                    std::vector<std::string> row;
                    if (element.is_array()) {
                        for (const toml::node& part : *element.as_array()) {
                            row.push_back(word(part, name));
                        }
                    } else {
                        row.push_back(word(element, name));
                    }
                    entry.values.push_back(std::move(row));
                }
            }
            out_.expected.push_back(std::move(entry));
        }
    }

    Source source_;
    std::string name_;
    toml::table root_;
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
