// Packings of other programs: mutants are refused by name, or read without losing a row.

#include "fuzz/harness.hpp"
#include "support/scratch.hpp"

#include <isostat/compare/compare.hpp>
#include <isostat/foreign/foreign.hpp>
#include <isostat/io/state_file.hpp>

#include <cctype>

using namespace fuzz;

namespace {

const std::string dump =
    "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS ff ff pp\n-1 3\n0.5 2.5\n-0.5 0.5\n"
    "ITEM: ATOMS id type x y z radius\n2 1 2 1.5 0 0.75\n1 1 0 1.25 0 0.25\n"
    "ITEM: TIMESTEP\n100\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS ff ff pp\n-1 3\n0.5 2.5\n"
    "-0.5 0.5\nITEM: ATOMS id type x y z radius\n2 1 2 1.5 0 0.75\n1 1 0 1.25 0 0.25\n";
const std::string data_file = "LAMMPS data file\n\n2 atoms\n1 atom types\n\n-1 3 xlo xhi\n0.5 2.5 ylo yhi\n"
                              "-0.5 0.5 zlo zhi\n\nAtoms # sphere\n\n1 1 0.5 2.5 0 1.25 0\n2 1 1.5 2.5 2 1.5 0 # c\n\n"
                              "Velocities\n\n1 0 0 0 0 0 0\n2 0 0 0 0 0 0\n";
const std::string xyz = "2\nLattice=\"4 0 0 0 2 0 0 0 1\" Origin=\"-1 0.5 0\" pbc=\"F F F\" "
                        "Properties=species:S:1:pos:R:3:radius:R:1 Time=3\nA 0 1.25 0 0.25\nB 2 1.5 0 0.75\n";
const std::string sphere_xyz = "2\nLattice=\"4 1 0 0 2 0 0.5 0 1\" Properties=pos:R:3:radius:R:1\n"
                               "0 1.25 0.5 0.25\n2 1.5 0.25 0.75\n";
const std::string table = "# made by hand\n# x y r\n0 1.25 0.25\n2 1.5 0.75\n4 0.5 0.125\n";
const std::string csv = "id,x,y,diameter,name\n7,0,1.25,0.5,a\n3,2,1.5,1.5,b\n";
const std::string spheres = "3\n2\n0.5\n1 0 0\n0.25 2 0\n0.5 0.5 4\n0.25 0.5 0.75\n0.75 0.5 0.25\n";
const std::string bare = "0.5 0.5 0.5\n1.5 0.5 0.5\n2.5 0.5 0.5\n";

/// Numbers by the C library, another reader than ours.
bool looks_like_a_number(const std::string& word) {
    char* end = nullptr;
    (void)std::strtod(word.c_str(), &end);
    return end == word.c_str() + word.size() || std::isdigit(static_cast<unsigned char>(word[0])) != 0;
}

/// Between separators, where there are any (then a blank is part of a cell); else words.
std::vector<std::string> cells_of(const std::string& row) {
    std::vector<std::string> cells;
    if (row.find_first_of(";,\t") == std::string::npos) {
        std::istringstream words(row);
        for (std::string word; words >> word;) {
            cells.push_back(word);
        }
        return cells;
    }
    for (std::size_t at = 0; at <= row.size();) {
        const std::size_t end = std::min(row.find_first_of(";,\t", at), row.size());
        const std::string cell = row.substr(at, end - at);
        const std::size_t first = cell.find_first_not_of(" \v\f\r\"");
        cells.push_back(
            first == std::string::npos ? "" : cell.substr(first, cell.find_last_not_of(" \v\f\r\"") + 1 - first));
        at = end + 1;
    }
    std::erase(cells, "");
    return cells;
}

/// Rows of a table: lines that are neither blank nor comments, without the names if the first such line is of names.
std::string table_rows(const std::string& text, std::size_t read) {
    std::vector<std::string> rows;
    std::ranges::copy_if(lines_of(text), std::back_inserter(rows), [](const auto& line) { return has_content(line); });
    if (rows.size() != read + 1) {
        return rows_differ(read, rows.size());
    }
    for (const std::string& word : cells_of(rows[0])) {
        if (looks_like_a_number(word)) {
            return "the first row was dropped: " + rows[0];
        }
    }
    return "";
}

/// The number before "atoms", the only place that says how many there are.
std::string data_rows(const std::string& text, std::size_t read) {
    for (const std::string& line : lines_of(text)) {
        std::istringstream words(line);
        std::string first, second;
        if (words >> first >> second && second == "atoms" && looks_like_a_number(first)) {
            return rows_differ(read, std::stoul(first));
        }
    }
    return "nothing says how many";
}

/// Lines after the last ITEM: ATOMS.
std::string dump_rows(const std::string& text, std::size_t read) {
    std::size_t counted = 0;
    for (const std::string& line : lines_of(text)) {
        counted =
            line.starts_with("ITEM: ATOMS") ? 0 : counted + (line.find_first_not_of(" \t\r") != std::string::npos);
    }
    return rows_differ(read, counted);
}

/// Every line belongs to a frame, and the last frame has as many rows as were read.
std::string xyz_rows(const std::string& text, std::size_t read) {
    const std::vector<std::string> lines = lines_of(text);
    std::size_t announced = 0, at = 0;
    while (at < lines.size() && has_content(lines[at])) {
        announced = std::stoul(lines[at].substr(lines[at].find_first_not_of(" \t+")));
        at += 2 + announced;
    }
    if (at > lines.size()) {
        return "the last frame is not complete";
    }
    for (; at < lines.size(); ++at) {
        if (lines[at].find_first_not_of(" \t\r") != std::string::npos) {
            return "a line after the last frame was dropped";
        }
    }
    return rows_differ(read, announced);
}

/// Two or three axes: rows of one number, of the dimension, the number of centres and the diameter; then as many as
/// said, and as many as there are axes where there are period vectors.
std::string centre_rows(const std::string& text, std::size_t read) {
    std::vector<std::string> rows;
    std::ranges::copy_if(lines_of(text), std::back_inserter(rows), [](const std::string& line) {
        return has_content(line) && line.find_first_not_of(" \t\r,") != std::string::npos;
    });
    const std::size_t axes = std::stoul(rows.at(0));
    return rows.size() == 3 + read || rows.size() == 3 + axes + read ? "" : rows_differ(read, rows.size() - 3);
}

std::string rows_of(const std::string& format, const std::string& text, std::size_t read) {
    return format == "table"         ? table_rows(text, read)
           : format == "lammps-data" ? data_rows(text, read)
           : format == "lammps-dump" ? dump_rows(text, read)
           : format == "centres"     ? centre_rows(text, read)
                                     : xyz_rows(text, read);
}

/// Read as the format stated, or as what it looks like.
std::string check(const std::string& changed, ForeignOptions options) {
    // Without a stated format the mutant may look like one of ours.
    const std::string found = recognise_format(changed);
    if (options.format.empty() && (found == "state" || found == "vertex" || found == "packing" || found.empty())) {
        return "";
    }
    const ForeignPacking read = parse_foreign(changed, "FILE", options);
    if (std::string wrong = unsound(read.packing); !wrong.empty()) {
        return wrong;
    }
    if (std::string wrong = rows_of(read.format, changed, read.packing.radius.size()); !wrong.empty()) {
        return wrong;
    }
    if (read.packing.cell.any()) {
        return ""; // no walls
    }
    options.walls = ForeignWalls::box;
    for (std::size_t a = 0; a < read.packing.axes(); ++a) {
        options.box.insert(options.box.end(), {-1e30, 1e30});
    }
    const auto far = [](double x) { return !(std::abs(x) < 1e30); };
    const bool outside = std::ranges::any_of(read.packing.q, far);
    return outside ? "" : unsound(parse_foreign(changed, "FILE", options).packing);
}

} // namespace

BOOST_AUTO_TEST_CASE(mutated_packings_of_other_programs_are_refused_by_name_or_lose_no_row) {
    for (const auto& [format, text] : {std::pair{"lammps-dump", dump},
                                       {"lammps-data", data_file},
                                       {"xyz", xyz},
                                       {"table", table},
                                       {"table", csv},
                                       {"centres", spheres},
                                       {"xyz", sphere_xyz}}) {
        for (const char* stated : {format, ""}) {
            ForeignOptions options{.format = stated, .cells = text == spheres || text == sphere_xyz};
            const Count tally = fuzz::fuzz(std::string(format) + " " + stated, text, 1500,
                                           [&](const std::string& changed) { return check(changed, options); });
            BOOST_TEST(tally.refused > 100);
            BOOST_TEST(tally.accepted > 10);
        }
    }
}

BOOST_AUTO_TEST_CASE(mutated_tables_with_stated_columns_lose_no_row) {
    ForeignOptions options{.format = "table", .columns = {"x", "y", "r"}};
    const auto read = [&](const std::string& changed) { return check(changed, options); };
    BOOST_TEST(fuzz::fuzz("bare table", bare, 3000, read).refused > 100);
    BOOST_TEST(fuzz::fuzz("table with its own names", "x y radius\n" + bare, 1500, read).refused > 100);
}

BOOST_FIXTURE_TEST_CASE(mutated_series_of_frames_are_refused_by_name_or_have_sound_frames, scratch::InFolder) {
    std::filesystem::copy(scratch::data("series"), folder / "series");
    const auto read = [&](const std::filesystem::path& file, const std::string& changed) {
        scratch::write(file, changed);
        try {
            compare::SeriesReader reader(folder / "series/series.toml");
            std::string wrong;
            while (const auto frame = reader.next()) {
                wrong += unsound(frame->packing);
            }
            return wrong;
        } catch (const Error& error) { // of the file, or of one that does not fit it any longer
            const std::string message = error.what();
            BOOST_TEST(message.starts_with(folder.at("series")), message);
            throw Error(error.kind(), "FILE " + message);
        }
    };
    for (const char* name : {"series.toml", "frames.csv", "disks.dump", "contacts.dump"}) {
        const std::filesystem::path file = folder / "series" / name;
        const std::string text = scratch::read(file);
        const auto check = [&](const std::string& changed) { return read(file, changed); };
        BOOST_TEST(fuzz::fuzz(name, text, 400, check).refused > 50);
        scratch::write(file, text);
    }
}

BOOST_AUTO_TEST_CASE(files_with_announced_rows_are_refused_wherever_they_are_cut) {
    const auto cut = [](const std::string& text, const std::string& format, std::size_t complete) {
        ForeignOptions options{.format = format};
        for (std::size_t size = 0; size + 1 < text.size(); ++size) {
            const std::string part = text.substr(0, size);
            if (size == complete || size + 1 == complete) {
                continue; // a whole frame
            }
            try {
                const ForeignPacking read = parse_foreign(part, "FILE", options);
                // Only a number cut short at the very end passes; that is said.
                BOOST_TEST(std::any_of(read.notes.begin(), read.notes.end(),
                                       [](const std::string& note) { return note.find("cut") != std::string::npos; }),
                           format << " cut at " << size << " is accepted in silence");
            } catch (const Error& error) {
                BOOST_TEST(std::string(error.what()).starts_with("FILE"));
            }
        }
    };
    cut(dump, "lammps-dump", dump.find("ITEM: TIMESTEP", 1));
    cut(data_file.substr(0, data_file.find("\nVelocities")), "lammps-data", std::string::npos);
    cut(xyz, "xyz", std::string::npos);
}
