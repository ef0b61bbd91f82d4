//! Processor in the loop: takes ticks from the serial port, computes torques, sends them back.
//!
//! Nothing here needs an emulator or a debugger: the same program runs on a board. It never ends.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
mod program {
    use board::{Board, Clock, Serial};
    use mm_link::{Identity, Node, Port};

    board::program!(run);

    /// Instructions of the loop that says how long one takes.
    const LOOP: u32 = 10_000;

    /// Instructions between two looks at an empty port: few enough for 500,000 baud.
    const IDLE: u32 = 200;

    struct Wire<'a>(&'a mut Serial);

    impl Port for Wire<'_> {
        #[inline(always)]
        fn read(&mut self) -> Option<u8> {
            self.0.try_read()
        }
        fn write(&mut self, bytes: &[u8]) {
            self.0.write(bytes);
        }
    }

    struct Timer<'a>(&'a Clock);

    impl mm_link::Clock for Timer<'_> {
        #[inline(always)]
        fn ticks(&self) -> u32 {
            self.0.ticks()
        }
    }

    fn run(board: &mut Board) -> bool {
        let clock = Timer(&board.clock);
        let loop_ticks = looped(&clock, LOOP).saturating_sub(looped(&clock, 0));
        let mut node =
            Node::new(Identity { target: board::NAME, ticks_per_second: board::CLOCK_HZ, loop_ticks });
        let mut port = Wire(&mut board.serial);
        loop {
            if !node.poll(&mut port, &clock) {
                // An emulator has better to do than to look at an empty port all the time.
                clock.0.spend(IDLE);
            }
        }
    }

    /// Ticks that a loop takes.
    #[inline(never)]
    fn looped(clock: &Timer<'_>, instructions: u32) -> u32 {
        let begin = clock.0.ticks();
        clock.0.spend(instructions);
        clock.0.ticks().wrapping_sub(begin) & 0x00ff_ffff
    }
}

#[cfg(not(target_os = "none"))]
fn main() {}
