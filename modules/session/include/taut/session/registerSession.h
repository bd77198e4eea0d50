#pragma once

namespace taut
{
/** Tells MRPT's class factory of all classes that a method file may name but for renderers: call it
 * before Method::read(). */
void registerSession();
}  // namespace taut
