//! The drive as a master sees it: frames in, demands and frames out, over an axis that follows every demand.
mod axis;
mod cyclic;
mod power;
