//! What a sweep gave, in words and drawn: what is read off it is what went in, whatever that is.
mod drawn;
mod hostile;
mod samples;
mod words;
