# Writes a source file with the number of this build (src/loop/build_id.h): cmake -DSOURCE=src -DOPTIONS=… -DOUT=… -P
set(folders signals machine estimation control safety gate bus)
list(TRANSFORM folders PREPEND ${SOURCE}/)
list(TRANSFORM folders APPEND "/*.*")
file(GLOB_RECURSE sources RELATIVE ${SOURCE} ${folders})
list(SORT sources)
set(all "${OPTIONS}")
foreach(name ${sources})
  file(SHA256 ${SOURCE}/${name} sum)
  string(APPEND all "${name} ${sum}\n")
endforeach()
string(SHA256 sum "${all}")
string(SUBSTRING ${sum} 0 16 number)
file(WRITE ${OUT} "#include \"loop/build_id.h\"\n
namespace robot_control {

std::uint64_t build_id() noexcept {
  return 0x${number}ULL;
}

}  // namespace robot_control
")
