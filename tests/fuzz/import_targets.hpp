// Models of other programs as bytes from outside. Each returns where the program gave a documented answer: the file understood,
// or refused with its name. Anything else escapes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace elastocheck::fuzz {

void adm(std::string_view input);
void chrono(std::string_view input);
void property(std::string_view input);   // .bus, .spr, .bum, .reb
void subsystem(std::string_view input);  // .sub

int fuzz_adm(const std::uint8_t* data, std::size_t size);
int fuzz_chrono(const std::uint8_t* data, std::size_t size);
int fuzz_property(const std::uint8_t* data, std::size_t size);
int fuzz_subsystem(const std::uint8_t* data, std::size_t size);

}  // namespace elastocheck::fuzz
