#pragma once
// Who alters the records of a run can compute its digests too: a checker must not rest on them.

#include "io/record_digests.hpp"
#include "support/bad_input.hpp"
#include "support/scratch.hpp"

#include <isostat/checker/verify.hpp>
#include <isostat/io/state_file.hpp>

namespace forger {

/// Makes every digest in checkpoint.json that of what the folder holds now, and its state that of states/last.json.
inline void seal(const std::filesystem::path& folder) {
    const std::filesystem::path path = folder / "checkpoint.json";
    if (!std::filesystem::exists(path)) {
        return;
    }
    const std::string old = scratch::read(path);
    auto object = isostat::json::Json::parse(old);
    object.erase("digest");
    object.erase("state");
    for (auto& [name, digest] : object["files"].items()) {
        digest = isostat::sha256(scratch::read(folder / name));
    }
    for (auto& [name, bytes] : object["bytes"].items()) {
        const std::string text = scratch::read(folder / name);
        std::string digest;
        for (std::size_t begin = 0; begin < text.size();) {
            const std::size_t end = std::min(text.find('\n', begin), text.size() - 1) + 1;
            digest = isostat::chained(digest, text.substr(begin, end - begin));
            begin = end;
        }
        bytes = text.size();
        object["digests"][name] = digest;
    }
    std::string text = object.dump();
    text.pop_back();
    text += isostat::before_state + scratch::read(folder / "states" / "last.json");
    scratch::write(path, text + isostat::before_digest + '"' + isostat::sha256(text) + "\"}\n");
}

/// The text of the value of "name", or of the head of its list, in the first record that has it.
inline std::string value_of(const std::string& text, const std::string& name) {
    const std::size_t at = text.find("\"" + name + "\":");
    BOOST_REQUIRE_MESSAGE(at != std::string::npos, name);
    const std::size_t begin = at + name.size() + 3;
    return text.substr(begin, text.find_first_of(",}]", begin) - begin);
}

/// A number in a record, multiplied.
inline std::string times(const std::string& number, double factor) {
    return fmt::format("{:.17g}", std::stod(number) * factor);
}

/// A line of equilibria.csv, of which line 0 has the names, with the field of a column replaced.
inline std::string row_with(const std::string& csv, std::size_t line, const std::string& column,
                            const std::string& value) {
    const std::vector<std::string> lines = scratch::split(csv, '\n');
    const std::vector<std::string> names = scratch::split(lines.at(0).substr(2), ',');
    std::vector<std::string> fields = scratch::split(lines.at(line), ',');
    fields.at(static_cast<std::size_t>(std::ranges::find(names, column) - names.begin())) = value;
    return scratch::joined(fields, ',');
}

/// One text in a file of a run in the place of another, with the digests of that; in the end the folder is as before.
class Alteration {
  public:
    Alteration(std::filesystem::path folder, const std::string& file, const std::string& from, const std::string& to)
        : folder_(std::move(folder)), file_(folder_ / file), original_(scratch::read(file_)) {
        const std::string changed = scratch::replaced(original_, from, to);
        BOOST_REQUIRE(changed != original_);
        write(changed);
    }
    ~Alteration() { write(original_); }
    Alteration(const Alteration&) = delete;
    Alteration& operator=(const Alteration&) = delete;

  private:
    void write(const std::string& text) const {
        scratch::write(file_, text);
        seal(folder_);
    }
    std::filesystem::path folder_, file_;
    std::string original_;
};

/// What `verify` says of a run that is altered so.
inline isostat::RunVerification altered(const std::filesystem::path& folder, const std::string& file,
                                        const std::string& from, const std::string& to) {
    const Alteration there(folder, file, from, to);
    return isostat::verify_run(folder);
}

/// One text in a file in the place of another is no record: the message names the file, and what is wrong in it.
inline void unreadable(const std::filesystem::path& folder, const std::string& file, const std::string& from,
                       const std::string& to, const std::string& said) {
    BOOST_TEST_INFO_SCOPE(file << ": " << from << " -> " << to);
    const Alteration there(folder, file, from, to);
    expect_bad_input([&] { (void)isostat::verify_run(folder); }, {file, said});
}

/// A certificate with the digest that belongs to it: taken from the reader's message.
inline std::string sealed_certificate(const std::string& text) {
    try {
        (void)isostat::parse_certificate(text, "forged");
    } catch (const isostat::Error& error) {
        const std::string message = error.what();
        const std::size_t at = message.find("expected \""), old = text.find("\"digest\":");
        if (message.find("digest is") != std::string::npos && at != std::string::npos && old != std::string::npos) {
            return std::string(text).replace(text.find('"', old + 9) + 1, 64, message, at + 10, 64);
        }
    }
    return text; // refused for another reason already
}

} // namespace forger
