//! A local page that answers while a target is drawn.
//!
//! ```text
//! messages.rs     the messages between a tab and the studio, as JSON
//! asked.rs        a tab's edit as a problem file, and a problem file as an edit
//! tables.rs       the tables of a problem file and their keys in an edit; kept.rs: the keys that have no control
//! targets.rs      the body of a motion and the angles of a function in an edit, as lines of a problem file
//! pin_map.rs      the map of the places of a pin of a motion's body
//! reading.rs      texts that are pasted or dropped, read by the readers of files
//! tab.rs          one tab's work: a mailbox of one, the answers that follow the hand, the search behind them
//! jobs.rs         long searches that are saved; shelf.rs: the folder of results
//! details.rs      one linkage: what the report says of it, files, comparisons
//! loads.rs        what turns a linkage: torque with a weight at P and springs
//! workshop.rs     what a maker takes: layers and clearances, one archive of everything
//! status.rs       how a search ended, in words
//! routes.rs       every request that is answered; openapi.rs: the same described
//! server.rs       the server, the page, the WebSocket
//! house.rs        the state that all requests share, the form of their answers
//! guard.rs        admission: Host, Origin, token and cookie, rate; headers of every answer
//! connection.rs   how many connections there may be, and for how long a silent one stays
//! page/           the page, its style and its script: built from studio/
//! ```
//!
//! The studio listens on 127.0.0.1 alone and reads no file but results in the folder that it was given: targets come
//! as points. It does no mathematics: what follows the hand is [`live`](crate::synthesis::live), what is searched is
//! [`run`](mod@crate::app::job::run), what is saved is saved by [`save`](crate::app::job::save), as on the command line.

mod asked;
mod connection;
mod details;
mod guard;
mod house;
pub mod job_messages;
mod jobs;
mod kept;
mod loads;
pub mod messages;
pub mod openapi;
mod pin_map;
pub mod reading;
mod routes;
mod server;
mod shelf;
mod status;
mod tab;
mod tables;
mod targets;
mod workshop;

pub use asked::{AskError, MOST_POINTS, NotHere};
pub use server::{Doorkeeper, Studio, StudioError};
