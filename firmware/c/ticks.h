/* What the ticks need of a machine, and the other way round. */
#ifndef TICKS_H
#define TICKS_H

/* Writes a text. */
void say(const char *text);

/* Runs all cases and says a line for each tick; 0 where every call was well. */
int ticks(void);

/* Bytes of stack used since the last call, or 0 where that is not known. */
unsigned long stack_used(void);

#endif
