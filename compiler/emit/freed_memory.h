// Memory that the heap keeps after it was freed.
#pragma once

namespace plumb::compiler {

// Gives back to the system what was freed: bodies are small blocks, which free alone keeps for later. O(pages of the heap).
void ReturnFreedMemory();

}  // namespace plumb::compiler
