// Random mutations of every file that is read: refused with a message that names the file, or accepted and sound.

#include "oracle/random.hpp"
#include "support/scratch.hpp"

#include <isostat/core/error.hpp>
#include <isostat/io/certificate_file.hpp>
#include <isostat/io/foreign.hpp>
#include <isostat/io/state_file.hpp>
#include <isostat/io/vertex_text.hpp>
#include <isostat/scene/scene.hpp>

#include <boost/test/unit_test.hpp>

#include <cmath>
#include <functional>

namespace {

using namespace isostat;
using oracle::Random;

/// One to four changes: bytes, digits, pieces lost, doubled or swapped, words that readers fear, or an early end.
std::string mutated(std::string text, Random& random) {
    static const std::vector<std::string> words{"nan",    "inf",    "-1",
                                                "1e999",  "0",      "99999999999999999999",
                                                "\n",     "\"",     "{",
                                                "]",      "1e-400", ",",
                                                "#",      "ITEM:",  "\t",
                                                "0x1p-3", "-",      "\xff\xfe",
                                                "1e18",   "+",      std::string(1, '\0')};
    for (int changes = 1 + random.integer(4); changes > 0 && !text.empty(); --changes) {
        const auto size = static_cast<int>(text.size());
        const auto at = static_cast<std::size_t>(random.integer(size));
        const auto length = static_cast<std::size_t>(1 + random.integer(std::min(size, 40)));
        switch (random.integer(8)) {
        case 0: text[at] = static_cast<char>(random.integer(256)); break;
        case 1: text.erase(at, length); break;
        case 2: text.insert(at, text.substr(static_cast<std::size_t>(random.integer(size)), length)); break;
        case 3: text.insert(at, words[static_cast<std::size_t>(random.integer(static_cast<int>(words.size())))]); break;
        case 4: text.resize(at); break;
        case 5: {
            const std::size_t digit = text.find_first_of("0123456789", at);
            if (digit != std::string::npos) {
                text[digit] = static_cast<char>('0' + random.integer(10));
            }
            break;
        }
        case 6: {
            const std::size_t line = text.find('\n', at),
                              end = line == std::string::npos ? line : text.find('\n', line + 1);
            if (end != std::string::npos) {
                const std::string moved = text.substr(line, end - line);
                text.erase(line, end - line);
                text.insert(std::min(text.size(), static_cast<std::size_t>(random.integer(size))), moved);
            }
            break;
        }
        default: {
            const std::size_t field = text.find_first_of(" ,:", at);
            const std::size_t end = field == std::string::npos ? field : text.find_first_of(" ,:\n", field + 1);
            if (end != std::string::npos) {
                text.replace(field + 1, end - field - 1,
                             words[static_cast<std::size_t>(random.integer(static_cast<int>(words.size())))]);
            }
        }
        }
    }
    return text;
}

struct Outcome {
    int accepted = 0, refused = 0;
};

/// `read` throws, or says whether what it read is sound.
Outcome fuzz(const std::string& name, const std::string& text, int samples,
             const std::function<bool(const std::string&)>& read) {
    Random random(2024);
    Outcome tally;
    BOOST_REQUIRE_MESSAGE(read(text), name + ": the original is read");
    for (int s = 0; s < samples; ++s) {
        const std::string changed = mutated(text, random);
        try {
            const bool sound = read(changed);
            BOOST_TEST(sound, name << ", sample " << s << ": accepted, and not sound:\n" << changed.substr(0, 2000));
            ++tally.accepted;
        } catch (const Error& error) {
            const std::string message = error.what();
            BOOST_TEST(message.starts_with("FILE"), name << ", sample " << s << ": " << message);
            BOOST_TEST(message.size() > 12U);
            BOOST_TEST((error.kind() == ErrorKind::bad_input));
            ++tally.refused;
        } catch (const std::exception& error) {
            BOOST_ERROR(name + ", sample " + std::to_string(s) + ": " + error.what() + "\n" + changed.substr(0, 2000));
        }
    }
    BOOST_TEST_MESSAGE(name << ": " << tally.refused << " refused, " << tally.accepted << " accepted");
    return tally;
}

bool sound(const Packing<2>& packing) {
    bool ok = !packing.radius.empty() && packing.q.size() == 2 * packing.radius.size() + 2 &&
              (packing.fixed.empty() || packing.fixed.size() == packing.radius.size());
    for (const double r : packing.radius) {
        ok = ok && r > 0 && std::isfinite(r);
    }
    for (const double x : packing.q) {
        ok = ok && std::isfinite(x);
    }
    return ok;
}

bool sound(const State<2>& state) {
    const int n = state.packing.disk_count();
    std::vector<Contact> sorted = state.contacts;
    std::sort(sorted.begin(), sorted.end());
    bool ok = sound(state.packing) && std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end();
    for (const Contact& c : state.contacts) {
        const bool pair = c.kind == ContactKind::disk_disk;
        ok = ok && c.i >= 0 && c.j >= 0 && (c.kind == ContactKind::held ? c.i < 2 * n + 2 : c.i < n) &&
             (pair ? c.i < c.j && c.j < n : c.j < 2);
    }
    return ok &&
           (state.load.infinitesimal.empty() || state.load.infinitesimal.size() == 2U * static_cast<std::size_t>(n));
}

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
const std::string table = "# made by hand\n# x y r\n0 1.25 0.25\n2 1.5 0.75\n";
const std::string csv = "id,x,y,diameter,name\n7,0,1.25,0.5,a\n3,2,1.5,1.5,b\n";

ForeignPacking foreign(const std::string& text, const std::string& format) {
    ForeignOptions options;
    options.format = format;
    return parse_foreign(text, "FILE", options);
}

} // namespace

BOOST_AUTO_TEST_SUITE(io_fuzz)

BOOST_AUTO_TEST_CASE(mutated_foreign_packings_are_refused_by_name_or_are_sound) {
    for (const auto& [format, text] :
         {std::pair{"lammps-dump", dump}, {"lammps-data", data_file}, {"xyz", xyz}, {"table", table}, {"table", csv}}) {
        for (const char* stated : {format, ""}) {
            const Outcome tally = fuzz(std::string(format) + " " + stated, text, 1500, [&](const std::string& changed) {
                ForeignOptions options;
                options.format = stated;
                // Without a stated format the mutant may look like one of ours.
                const std::string found = recognise_format(changed);
                if (*stated == '\0' && (found == "state" || found == "vertex" || found == "packing" || found.empty())) {
                    return true;
                }
                const ForeignPacking packing = parse_foreign(changed, "FILE", options);
                options.walls = ForeignWalls::box;
                options.box = {-1e30, 1e30, -1e30, 1e30};
                bool inside = true;
                for (const double x : packing.packing.q) {
                    inside = inside && std::abs(x) < 1e30;
                }
                return sound(packing.packing) && (!inside || sound(parse_foreign(changed, "FILE", options).packing));
            });
            BOOST_TEST(tally.refused > 100);
            BOOST_TEST(tally.accepted > 10);
        }
    }
}

BOOST_AUTO_TEST_CASE(mutated_states_and_vertices_are_refused_by_name_or_are_sound) {
    const State<2> vertex = parse_vertex_text(scratch::read(scratch::data("vertex100.txt")), "FILE");
    State<2> small;
    small.packing.radius = {1, 2};
    small.packing.q = {1, 1, 1 + 2 * std::sqrt(2.0), 2, 3 + 2 * std::sqrt(2.0), 4};
    small.load.stress = {1, 1};
    small.load.reference_length = {small.packing.length(0), small.packing.length(1)};
    small.load.infinitesimal = {0.1, 0.2, 0.3, 0.4};
    small.contacts = {{ContactKind::disk_disk, 0, 1},  {ContactKind::lower_wall, 0, 0},
                      {ContactKind::lower_wall, 0, 1}, {ContactKind::lower_wall, 1, 1},
                      {ContactKind::upper_wall, 1, 0}, {ContactKind::upper_wall, 1, 1}};
    const auto read_state_text = [](const std::string& text) { return sound(parse_state<2>(text, "FILE").state); };
    BOOST_TEST(fuzz("state", state_text<2>(small, std::vector<double>(6, 1.0)), 3000, read_state_text).refused > 500);
    BOOST_TEST(fuzz("state of 100", state_text<2>(vertex), 300, read_state_text).refused > 50);
    const auto read_vertex = [](const std::string& text) { return sound(parse_vertex_text(text, "FILE")); };
    BOOST_TEST(fuzz("vertex", scratch::read(scratch::data("vertex100.txt")), 500, read_vertex).refused > 50);
}

BOOST_AUTO_TEST_CASE(mutated_scenes_are_refused_by_name_or_can_be_read) {
    const std::string text = scratch::read(scratch::data("biaxial-100.toml"));
    BOOST_TEST(fuzz("scene", text, 1500, [](const std::string& changed) {
                   (void)parse_scene(changed, "FILE", std::filesystem::path(ISOSTAT_TEST_DATA));
                   return true;
               }).refused > 200);
}

BOOST_AUTO_TEST_CASE(mutated_certificates_are_refused_by_their_digest) {
    Certificate certificate;
    certificate.state.packing.radius = {1};
    certificate.state.packing.q = {1, 1, 2, 2};
    certificate.state.load.stress = {1, 1};
    certificate.state.load.reference_length = {2, 2};
    certificate.state.contacts = {{ContactKind::lower_wall, 0, 0},
                                  {ContactKind::lower_wall, 0, 1},
                                  {ContactKind::upper_wall, 0, 0},
                                  {ContactKind::upper_wall, 0, 1}};
    certificate.input = "one.json";
    certificate.input_hash = sha256("one");
    certificate.program = "test";
    certificate.claims.counting = CountingClaim{4, 4, 4, 0, 0, Rung::exact};
    const std::string text = certificate_text(certificate);
    const Outcome tally = fuzz("certificate", text, 1500, [&](const std::string& changed) {
        const Certificate read = parse_certificate(changed, "FILE");
        // What is accepted says what the original said: white space, or a mutation that undid itself.
        return certificate_text(read) == text;
    });
    BOOST_TEST(tally.refused > 1000);
}

BOOST_AUTO_TEST_CASE(files_with_announced_rows_are_refused_wherever_they_are_cut) {
    const auto cut = [](const std::string& text, const std::string& format, std::size_t complete) {
        for (std::size_t size = 0; size + 1 < text.size(); ++size) {
            const std::string part = text.substr(0, size);
            if (size == complete || size + 1 == complete) {
                continue; // a whole frame
            }
            try {
                const ForeignPacking read = foreign(part, format);
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
    const std::string state = state_text<2>(parse_vertex_text(scratch::read(scratch::data("vertex100.txt")), "FILE"));
    for (std::size_t size = 0; size + 2 < state.size(); size += 97) {
        BOOST_CHECK_THROW((void)parse_state<2>(state.substr(0, size), "FILE"), Error);
    }
}

BOOST_AUTO_TEST_SUITE_END()
