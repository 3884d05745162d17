
#include "ensemble/ensemble.hpp"
#include "io/files.hpp"
#include "io/folders.hpp"
#include "io/json.hpp"
#include "io/numbers.hpp"

namespace isostat {

namespace fs = std::filesystem;

bool is_ensemble(const fs::path& directory) {
    return fs::exists(directory / "ensemble.json") && !fs::exists(directory / "run.json");
}

std::vector<Member> members_of(const fs::path& directory) {
    const std::string path = (directory / "ensemble.json").string();
    (void)content_of(directory, ensemble_folder);
    check_mark(directory, ensemble_folder);
    const json::Json parsed = json::Field::parse(read_text(path), path);
    const json::Field file(parsed, path);
    EnsembleHeader header;
    header.samples = file.at("samples").integer(1, most_samples);
    const auto seed = plain_integer(file.at("first_seed").string());
    if (!seed || *seed < 0) {
        file.at("first_seed").fail("a seed");
    }
    header.first_seed = static_cast<std::uint64_t>(*seed);
    const SampleFolders folders(directory, header);
    std::vector<Member> members;
    for (std::size_t k = 0; k < static_cast<std::size_t>(header.samples); ++k) {
        const fs::path folder = folders.folder(k);
        const bool begun = fs::exists(folder / run_folder.mark);
        if (begun || members.empty() || members.back().begun) {
            members.push_back({folders.seed(k), folder, begun});
        } else {
            ++members.back().further;
        }
    }
    return members;
}

} // namespace isostat
