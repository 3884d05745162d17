#include "contact/images.hpp"
#include "io/files.hpp"
#include "io/toml.hpp"
#include "packing/unbalanced.hpp"
#include "packing/words.hpp"

#include <isostat/core/error.hpp>
#include <isostat/crafted/exact_packing.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <initializer_list>
#include <sstream>
#include <string_view>

namespace isostat::crafted {

namespace {

/// The lines of a document, addressed as toml++ does: line and column from 1, columns in code points.
class Source {
  public:
    explicit Source(const std::string& text) {
        std::istringstream stream(text);
        for (std::string line; std::getline(stream, line);) {
            lines_.push_back(line);
        }
    }
    /// Text of a region on one line.
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
        allow(root_, "", {"format", "title", "source", "note", "disks", "disk", "box", "cell", "load", "expected"});
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
        disks();
        cell();
        box();
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

    void allow(const toml::table& table, const std::string& where, std::initializer_list<std::string_view> keys) const {
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

    /// What a node holds, of one type; `wanted` is that in words.
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
                 "the number of a disk, 0 to " + std::to_string(n - 1));
        }
        return static_cast<int>(node.as_integer()->get());
    }

    void add_disk(Number x, Number y, Number r, bool fixed) {
        out_.packing.centre.push_back({std::move(x), std::move(y)});
        out_.packing.radius.push_back(std::move(r));
        out_.packing.fixed.push_back(fixed ? 1 : 0);
    }

    void disks() {
        if (const toml::node* node = root_.get("disks")) {
            for (const toml::node& entry : array(*node, "disks")) {
                const toml::array& row = array(entry, "disks", 3);
                add_disk(number(row[0], "disks: x"), number(row[1], "disks: y"), positive(row[2], "disks: r"), false);
            }
        }
        if (const toml::node* node = root_.get("disk")) {
            for (const toml::node& entry : array(*node, "disk")) {
                const toml::table& row = table(entry, "disk");
                allow(row, "disk.", {"x", "y", "r", "fixed"});
                const toml::node* fixed = row.get("fixed");
                add_disk(number(required(row, "x", "disk."), "disk.x"), number(required(row, "y", "disk."), "disk.y"),
                         positive(required(row, "r", "disk."), "disk.r"),
                         fixed != nullptr && boolean(*fixed, "disk.fixed"));
            }
        }
        if (out_.packing.radius.empty()) {
            throw Error(ErrorKind::bad_input, name_ + ":1: no disk, expected \"disks\" or [[disk]]");
        }
    }

    [[nodiscard]] WallKind wall(const toml::node& node, const std::string& key, std::size_t axis, bool may_move) const {
        const std::string kind = string(node, key);
        if (kind != "absent" && out_.packing.cell.periodic[axis]) {
            fail(node, key, "\"" + kind + "\"", fmt::format("\"absent\": {} repeats (cell.period)", "xy"[axis]));
        }
        if (const auto known = value_of<WallKind>(kind, wall_kind_words);
            known && (may_move || *known != WallKind::movable)) {
            return *known;
        }
        fail(node, key, "\"" + kind + "\"",
             may_move ? "\"absent\", \"fixed\" or \"movable\"" : "\"absent\" or \"fixed\"");
    }

    /// Which axes repeat, and what moves of the cell.
    void cell() {
        const toml::node* node = root_.get("cell");
        if (node == nullptr) {
            return;
        }
        const toml::table& cell = table(*node, "cell");
        allow(cell, "cell.", {"period", "tilt", "moves", "pin"});
        ExactPacking& packing = out_.packing;
        const toml::array& period = array(required(cell, "period", "cell."), "cell.period", 2);
        for (std::size_t a = 0; a < 2; ++a) {
            packing.cell.periodic[a] = !(period[a].is_string() && period[a].as_string()->get() == "none");
            if (packing.cell.periodic[a]) {
                packing.length[a] = positive(period[a], "cell.period");
            }
        }
        if (!packing.cell.any()) {
            fail(period, "cell.period", "[\"none\", \"none\"]", "one period at least: a box has no [cell]");
        }
        if (const toml::node* tilt = cell.get("tilt")) {
            packing.tilt = number(*tilt, "cell.tilt");
            if (!packing.tilt.is_zero() && !packing.cell.all()) {
                fail(*tilt, "cell.tilt", packing.tilt.text(), "0, as one axis does not repeat");
            }
        }
        for (const toml::node& moved : array(required(cell, "moves", "cell."), "cell.moves")) {
            moves(moved);
        }
        if (const toml::node* pin = cell.get("pin")) {
            packing.cell.pin = index(*pin, "cell.pin");
        }
        if (std::find(packing.fixed.begin(), packing.fixed.end(), 1) != packing.fixed.end()) {
            fail(*node, "disk.fixed", "true",
                 "no fixed disk where an axis repeats: the pinned one says where the "
                 "origin is");
        }
        fits(period);
    }

    void moves(const toml::node& moved) {
        Cell& cell = out_.packing.cell;
        const std::string word = string(moved, "cell.moves");
        const int axis = word == "x" ? 0 : (word == "y" ? 1 : 2);
        bool& flag = axis < 2 ? cell.period_moves[static_cast<std::size_t>(axis)] : cell.tilt_moves[0];
        const bool there = axis < 2 ? cell.periodic[static_cast<std::size_t>(axis)] : word == "xy" && cell.all();
        if (!there || flag) {
            fail(moved, "cell.moves", "\"" + word + "\"",
                 "\"x\", \"y\" of an axis that repeats, or \"xy\" where both do, each once");
        }
        flag = true;
    }

    /// No disk is wider than a period vector, or so far away that its images would not be found.
    void fits(const toml::array& period) const {
        const ExactPacking& packing = out_.packing;
        for (std::size_t i = 0; i < packing.radius.size(); ++i) {
            const Number diameter = packing.radius[i] + packing.radius[i];
            for (std::size_t a = 0; a < 2; ++a) {
                const Number& length = packing.length[a];
                const Number lean = a == 1 ? packing.tilt : Number(0);
                if (packing.cell.periodic[a] && (length * length + lean * lean - diameter * diameter).sign() < 0) {
                    fail(period[a], "cell.period", length.text(),
                         fmt::format("a period vector at least as long as the diameter {} of disk {}, which overlaps "
                                     "its own image",
                                     diameter.text(), i));
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
        for (std::size_t a = 0; a < 2; ++a) {
            const bool repeats = out_.packing.cell.periodic[a];
            out_.packing.walls.lower[a] = repeats ? WallKind::absent : WallKind::fixed;
            out_.packing.walls.upper[a] = repeats ? WallKind::absent : WallKind::movable;
        }
        for (const char* side : {"lower", "upper"}) {
            if (const toml::node* given = box.get(side)) {
                const bool up = side == std::string_view("upper");
                const std::string key = std::string("box.") + side;
                const toml::array& kinds = array(*given, key, 2);
                for (std::size_t a = 0; a < 2; ++a) {
                    (up ? out_.packing.walls.upper : out_.packing.walls.lower)[a] = wall(kinds[a], key, a, up);
                }
            }
        }
        const auto& upper = out_.packing.walls.upper;
        if (upper[0] == WallKind::absent && upper[1] == WallKind::absent && box.get("length") == nullptr) {
            return;
        }
        const toml::array& length = array(required(box, "length", "box."), "box.length", 2);
        for (std::size_t a = 0; a < 2; ++a) {
            if (upper[a] != WallKind::absent) {
                out_.packing.length[a] = positive(length[a], "box.length");
            } else if (!length[a].is_string() || length[a].as_string()->get() != "none") {
                fail(length[a], "box.length", "a value", "\"none\" for an absent wall");
            }
        }
    }

    void load() {
        const toml::node* node = root_.get("load");
        if (node == nullptr) {
            return;
        }
        const toml::table& load = table(*node, "load");
        allow(load, "load.", {"wall", "tilt", "disk"});
        ExactLoad out;
        if (const toml::node* walls = load.get("wall")) {
            const toml::array& forces = array(*walls, "load.wall", 2);
            for (std::size_t a = 0; a < 2; ++a) {
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
            out.tilt = number(*tilt, "load.tilt");
            if (!out.tilt.is_zero() && !out_.packing.cell.tilt_moves[0]) {
                fail(*tilt, "load.tilt", out.tilt.text(), "0: no tilt of a cell moves");
            }
        }
        if (const toml::node* disks = load.get("disk")) {
            out.disk = disk_forces(*disks);
        }
        out_.packing.load = std::move(out);
    }

    [[nodiscard]] std::vector<Number> disk_forces(const toml::node& node) const {
        std::vector<Number> out(2 * out_.packing.radius.size());
        for (const toml::node& entry : array(node, "load.disk")) {
            const toml::array& row = array(entry, "load.disk", 3);
            const int disk = index(row[0], "load.disk");
            if (out_.packing.is_fixed(disk)) {
                fail(row[0], "load.disk", std::to_string(disk), "a disk that is not fixed");
            }
            out[2 * static_cast<std::size_t>(disk)] += number(row[1], "load.disk");
            out[2 * static_cast<std::size_t>(disk) + 1] += number(row[2], "load.disk");
        }
        if (const auto rest = unbalanced<Number>(out, out_.packing.cell)) {
            fail(
                node, "load.disk", "forces that sum to " + rest->second.text(),
                fmt::format("0 along {}, which repeats: the pinned disk would bear the rest", axis_names[rest->first]));
        }
        return out;
    }

    /// A single value of `[expected]` as text: strings as they are, numbers exactly.
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
