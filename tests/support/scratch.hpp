#pragma once
// A folder of its own for a test, deleted at the end, and small helpers for files.

#include "support/test.hpp"

#include <unistd.h>

namespace scratch {

class Folder {
  public:
    Folder() {
        static int count = 0;
        path_ = std::filesystem::temp_directory_path() /
                ("isostat-test-" + std::to_string(::getpid()) + "-" + std::to_string(count++));
        std::filesystem::create_directories(path_);
    }
    ~Folder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
    [[nodiscard]] std::string at(const std::string& name) const { return (path_ / name).string(); }
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    // NOLINTNEXTLINE(google-explicit-constructor): a folder stands where its path is asked for
    operator const std::filesystem::path&() const { return path_; }
    /// The whole name of a file with this text.
    [[nodiscard]] std::string file(const std::string& name, const std::string& text) const {
        std::ofstream(path_ / name, std::ios::binary) << text;
        return at(name);
    }

  private:
    std::filesystem::path path_;
};

/// The fixture of a case with a folder.
struct InFolder {
    const Folder folder;
};

inline std::string read(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

inline void write(const std::filesystem::path& path, const std::string& text) {
    std::ofstream file(path, std::ios::binary);
    file << text;
}

inline std::string data(const std::string& name) {
    return std::string(ISOSTAT_TEST_DATA) + "/" + name;
}

/// The first occurrence of `from` replaced.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

/// How often `what` occurs.
inline int count(const std::string& text, const std::string& what) {
    int n = 0;
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) {
        ++n;
    }
    return n;
}

/// Words between blanks.
inline std::vector<std::string> split(const std::string& text) {
    std::istringstream in(text);
    return {std::istream_iterator<std::string>(in), {}};
}

/// Parts between separators; one at the end of the text makes no part.
inline std::vector<std::string> split(const std::string& text, char separator) {
    std::vector<std::string> parts;
    std::istringstream in(text);
    for (std::string part; std::getline(in, part, separator);) {
        parts.push_back(part);
    }
    return parts;
}

inline std::string joined(const std::vector<std::string>& parts, char separator) {
    std::string text;
    for (std::size_t k = 0; k < parts.size(); ++k) {
        text += (k > 0 ? std::string(1, separator) : "") + parts[k];
    }
    return text;
}

inline std::vector<std::string> lines_of(const std::filesystem::path& file) {
    return split(read(file), '\n');
}

/// A row of a table, from 0, by the names of its columns, which its first line has behind "# ".
inline std::map<std::string, std::string> row_of(const std::filesystem::path& table, std::size_t number) {
    const std::vector<std::string> lines = lines_of(table);
    const std::vector<std::string> names = split(lines.at(0).substr(2), ',');
    const std::vector<std::string> fields = split(lines.at(number + 1), ',');
    std::map<std::string, std::string> row;
    for (std::size_t k = 0; k < std::min(names.size(), fields.size()); ++k) {
        row[names[k]] = fields[k];
    }
    return row;
}

/// Writes a scene. The packing that it names by its whole name is copied beside it: scenes name files of their folder.
inline void write_scene(const std::filesystem::path& path, const std::string& text) {
    const std::string key = "\nfile = \"/";
    std::string scene = text;
    if (const std::size_t at = text.find(key); at != std::string::npos) {
        const std::size_t begin = at + key.size() - 1;
        const std::filesystem::path named = text.substr(begin, text.find('"', begin) - begin);
        std::filesystem::copy_file(named, path.parent_path() / named.filename(),
                                   std::filesystem::copy_options::overwrite_existing);
        scene.replace(begin, named.string().size(), named.filename().string());
    }
    write(path, scene);
}

/// equilibria.csv without its last column, the time.
inline std::string without_times(const std::string& csv) {
    std::string kept;
    for (const std::string& line : split(csv, '\n')) {
        kept += line.substr(0, line.rfind(',')) + "\n";
    }
    return kept;
}

} // namespace scratch
