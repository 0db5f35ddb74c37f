//! Macros that declare the lists of inputs, outputs and blocks; the lists themselves are in `blocks`.

/// Declares [`Input`](crate::Input): name of the variant, key in programs, `changes` if it may change while a block is executed, type,
/// meaning, and an addition where the input is documented with its default.
macro_rules! list_inputs {
    ($( $variant:ident $key:literal $change:ident $type:expr, $meaning:literal $(+ $more:literal)?; )+) => {
        /// An input of function blocks.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        pub enum Input {
            $( #[doc = concat!($meaning, ".")] $variant, )+
        }

        impl Input {
            /// Every input.
            pub const ALL: &'static [Self] = &[$(Self::$variant),+];

            /// Key in programs.
            #[must_use]
            pub const fn key(self) -> &'static str {
                match self { $(Self::$variant => $key,)+ }
            }

            /// Type of the value.
            #[must_use]
            pub const fn value_type(self) -> InputType {
                match self { $(Self::$variant => $type,)+ }
            }

            /// Meaning, in words.
            #[must_use]
            pub const fn meaning(self) -> &'static str {
                match self { $(Self::$variant => concat!($meaning, "."),)+ }
            }

            /// Meaning with the default.
            #[must_use]
            pub const fn meaning_with_default(self) -> &'static str {
                match self { $(Self::$variant => concat!($meaning, $($more,)? "."),)+ }
            }

            /// True if the input may change while a block is executed.
            #[must_use]
            pub const fn may_change(self) -> bool {
                match self { $(Self::$variant => list_inputs!(@may_change $change),)+ }
            }
        }
    };
    (@may_change changes) => { true };
    (@may_change stays) => { false };
}

/// Declares [`Output`](crate::Output): name of the variant, name in the standard, type, meaning.
macro_rules! list_outputs {
    ($( $variant:ident $name:literal $type:ident $meaning:literal; )+) => {
        /// An output of function blocks.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, servobench_base::Stateful)]
        pub enum Output {
            $( #[doc = concat!("`", $name, "`: ", $meaning, ".")] $variant, )+
        }

        impl Output {
            /// Name in the standard.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self { $(Self::$variant => $name,)+ }
            }

            /// Type of the value.
            #[must_use]
            pub const fn value_type(self) -> OutputType {
                match self { $(Self::$variant => OutputType::$type,)+ }
            }
        }
    };
}

/// Declares [`BlockName`](crate::BlockName): name of the variant, the block, its name in the standard, `command` if it is one, its meaning.
macro_rules! list_blocks {
    ($( $variant:ident: $block:ty, $name:literal $($command:ident)?, $meaning:literal; )+) => {
        /// A function block: of the standard, except `Profile4th` and `MAM`.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, servobench_base::Stateful)]
        pub enum BlockName {
            $( #[doc = concat!("`", $name, "`: ", $meaning, ".")] $variant, )+
        }

        impl BlockName {
            /// Every block.
            pub const ALL: &'static [Self] = &[$(Self::$variant),+];

            /// Name in the spelling of the standard, or of the paper.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self { $(Self::$variant => $name,)+ }
            }

            /// Meaning, in words.
            #[must_use]
            pub const fn meaning(self) -> &'static str {
                match self { $(Self::$variant => $meaning,)+ }
            }

            /// True if the block requests a motion or its end: the blocks of the state diagram.
            #[must_use]
            pub const fn is_command(self) -> bool {
                match self { $(Self::$variant => list_blocks!(@is_command $($command)?),)+ }
            }

            /// Input that starts and ends the block.
            #[must_use]
            pub const fn trigger(self) -> Trigger {
                match self { $(Self::$variant => <<$block as FunctionBlock>::Inputs<'static> as BlockInputs>::TRIGGER,)+ }
            }

            /// Inputs other than Execute or Enable.
            #[must_use]
            pub const fn inputs(self) -> &'static [BlockInput] {
                match self { $(Self::$variant => <<$block as FunctionBlock>::Inputs<'static> as BlockInputs>::INPUTS,)+ }
            }

            /// True if the inputs apply as they are in every cycle, rather than as they were at the start.
            #[must_use]
            pub const fn follows_inputs(self) -> bool {
                match self {
                    $(Self::$variant => <<$block as FunctionBlock>::Inputs<'static> as BlockInputs>::ARE_FOLLOWED,)+
                }
            }

            /// Outputs, in the order of the standard.
            #[must_use]
            pub const fn outputs(self) -> &'static [Output] {
                match self { $(Self::$variant => <<$block as FunctionBlock>::Outputs as Outputs>::LIST,)+ }
            }

            /// A new instance for a program, with room for the tables of `inputs`.
            #[cfg(feature = "program")]
            pub(crate) fn instance(
                self,
                inputs: &crate::program::Inputs,
            ) -> alloc::boxed::Box<dyn crate::program::Instance> {
                match self { $(Self::$variant => crate::program::called::<$block>(inputs),)+ }
            }
        }
    };
    (@is_command command) => { true };
    (@is_command) => { false };
}

pub(crate) use {list_blocks, list_inputs, list_outputs};
