#include "io/files.hpp"
#include "io/toml.hpp"

#include <isostat/core/error.hpp>
#include <isostat/crafted/exact_packing.hpp>

#include <fmt/format.h>

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
        allow(root_, "", {"format", "title", "source", "note", "disks", "disk", "box", "load", "expected"});
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
                std::string wanted;
                for (const std::string_view k : keys) {
                    wanted += (wanted.empty() ? "" : ", ") + std::string(k);
                }
                throw Error(ErrorKind::bad_input, fmt::format("{}:{}: unknown key \"{}{}\", expected one of {}", name_,
                                                              key.source().begin.line, where, key.str(), wanted));
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

    [[nodiscard]] const toml::table& table(const toml::node& node, const std::string& key) const {
        if (!node.is_table()) {
            fail(node, key, type_name(node), "a table");
        }
        return *node.as_table();
    }

    [[nodiscard]] const toml::array& array(const toml::node& node, const std::string& key, std::size_t size = 0) const {
        if (!node.is_array()) {
            fail(node, key, type_name(node), "an array");
        }
        const toml::array& out = *node.as_array();
        if (size != 0 && out.size() != size) {
            fail(node, key, "an array of " + std::to_string(out.size()), "an array of " + std::to_string(size));
        }
        return out;
    }

    [[nodiscard]] std::string string(const toml::node& node, const std::string& key) const {
        if (!node.is_string()) {
            fail(node, key, type_name(node), "a string");
        }
        return node.as_string()->get();
    }

    [[nodiscard]] bool boolean(const toml::node& node, const std::string& key) const {
        if (!node.is_boolean()) {
            fail(node, key, type_name(node), "true or false");
        }
        return node.as_boolean()->get();
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

    [[nodiscard]] WallKind wall(const toml::node& node, const std::string& key, bool may_move) const {
        const std::string kind = string(node, key);
        if (kind == "absent") {
            return WallKind::absent;
        }
        if (kind == "fixed") {
            return WallKind::fixed;
        }
        if (kind == "movable" && may_move) {
            return WallKind::movable;
        }
        fail(node, key, "\"" + kind + "\"",
             may_move ? "\"absent\", \"fixed\" or \"movable\"" : "\"absent\" or \"fixed\"");
    }

    void box() {
        const toml::node* node = root_.get("box");
        if (node == nullptr) {
            return;
        }
        const toml::table& box = table(*node, "box");
        allow(box, "box.", {"length", "lower", "upper"});
        out_.packing.walls = Walls<2>::box();
        if (const toml::node* lower = box.get("lower")) {
            const toml::array& kinds = array(*lower, "box.lower", 2);
            out_.packing.walls.lower = {wall(kinds[0], "box.lower", false), wall(kinds[1], "box.lower", false)};
        }
        if (const toml::node* upper = box.get("upper")) {
            const toml::array& kinds = array(*upper, "box.upper", 2);
            out_.packing.walls.upper = {wall(kinds[0], "box.upper", true), wall(kinds[1], "box.upper", true)};
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
        allow(load, "load.", {"wall", "disk"});
        ExactLoad out;
        if (const toml::node* walls = load.get("wall")) {
            const toml::array& forces = array(*walls, "load.wall", 2);
            for (std::size_t a = 0; a < 2; ++a) {
                out.wall[a] = number(forces[a], "load.wall");
                if (!out.wall[a].is_zero() && out_.packing.walls.upper[a] != WallKind::movable) {
                    fail(forces[a], "load.wall", out.wall[a].text(), "0: the upper wall of this axis is not movable");
                }
            }
        }
        if (const toml::node* disks = load.get("disk")) {
            out.disk.resize(2 * out_.packing.radius.size());
            for (const toml::node& entry : array(*disks, "load.disk")) {
                const toml::array& row = array(entry, "load.disk", 3);
                const int disk = index(row[0], "load.disk");
                if (out_.packing.is_fixed(disk)) {
                    fail(row[0], "load.disk", std::to_string(disk), "a disk that is not fixed");
                }
                out.disk[2 * static_cast<std::size_t>(disk)] += number(row[1], "load.disk");
                out.disk[2 * static_cast<std::size_t>(disk) + 1] += number(row[2], "load.disk");
            }
        }
        out_.packing.load = std::move(out);
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
